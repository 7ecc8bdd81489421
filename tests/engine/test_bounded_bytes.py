"""Memory stays bounded however large a node's messages are: real nodes, real DDS."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path

import pytest

from tests.engine.helpers import FILE, PUBLISHES, Scene, node
from tutor.judge.bench import Run

CHATTER = {"/chatter": "std_msgs/msg/String"}
STARTUP_S = 30.0
MB = 1_000_000

PUBLISHES_BOTH = """
large, raw = node.create_publisher(String, "large", 10), node.create_publisher(String, "raw", 10)
node.create_timer(0.2, lambda: large.publish(String(data="x" * 3_000_000)))
node.create_timer(0.2, lambda: raw.publish(bytes([0, 1, 0, 0, 255, 255, 255, 127])))
"""
LARGE_PARAMETERS = """
node.declare_parameter("rate", 2.5)
for number in range(3):
    node.declare_parameter(f"large_{number}", "x" * 20_000_000)
node.declare_parameter("name", "thermometer")
"""


def resident_mb() -> float:
    """Return the resident memory of this process."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4 / 1024


async def test_messages_too_large_to_decode_are_counted_and_undecodable_ones_are_not_our_fault(scene: Scene) -> None:
    from tutor.ros.observer import Observer
    from tutor.ros_model import QoS

    async with scene.bench(node(PUBLISHES_BOTH)).start(FILE) as run:
        observer = Observer(run._domain_id)  # type: ignore[attr-defined]
        try:
            for topic in ("/large", "/raw"):
                observer.watch(topic, CHATTER["/chatter"], QoS("reliable", "volatile"))
            assert await run.until(
                lambda: len(observer.samples["/large"]) >= 3 and len(observer.samples["/raw"]) >= 2, STARTUP_S
            )
            large, raw = (
                {sample.message["data"] for sample in observer.samples[topic]} for topic in ("/large", "/raw")
            )
        finally:
            observer.close()
    assert large == {"(a message of 3.0 MB, too large to decode)"}
    assert raw == {"(8 bytes that are not a valid String)"}


async def test_a_flood_of_oversized_messages_is_dropped_and_other_nodes_are_still_received(scene: Scene) -> None:
    flood = node(
        'publisher = node.create_publisher(String, "chatter", 10)',
        'message = String(data="x" * 100_000_000)',
        "node.create_timer(0.1, lambda: publisher.publish(message))",
    )
    bench = replace(scene.bench(flood), submission=scene.submission(node=flood, quiet=node(PUBLISHES)))
    async with bench.start("quiet.py", watch=CHATTER) as quiet:
        await _wait_for_samples(quiet, 5)
        before, peak = resident_mb(), 0.0
        async with bench.start(FILE, watch=CHATTER) as loud:
            assert await loud.until(lambda: bool(loud.graph.publishers), STARTUP_S)
            for _ in range(100):
                await asyncio.sleep(0.03)  # about how often the observer takes samples
                peak = max(peak, resident_mb())
            assert not loud.samples_on("/chatter")
            await _wait_for_samples(quiet, len(quiet.samples_on("/chatter")) + 20)
    assert peak - before < 100


async def _wait_for_samples(run: Run, count: int) -> None:
    assert await run.until(lambda: len(run.samples_on("/chatter")) >= count, STARTUP_S)


@pytest.mark.parametrize("guarded_mb", [4, 1000])  # all of a large one arrives in the second case, and at times before
async def test_oversized_parameters_are_reported_and_the_others_read(
    scene: Scene, monkeypatch: pytest.MonkeyPatch, guarded_mb: int
) -> None:
    from tutor.ros import memory_guard

    monkeypatch.setattr(memory_guard, "MAX_BYTES", guarded_mb * MB)
    async with scene.bench(node(LARGE_PARAMETERS)).start(FILE) as run:
        assert await run.until(
            lambda: any(s.name == "/learner/set_parameters_atomically" for s in run.graph.services), STARTUP_S
        )
        before = resident_mb()
        declared = await run.parameters(30.0)
        assert resident_mb() - before < 100
    found = {each.name: (each.type, each.value) for each in declared or ()}
    assert found["rate"] == ("double", 2.5)
    assert found["name"] == ("string", "thermometer")
    for number in range(3):
        kind, value = found[f"large_{number}"]
        assert kind == "string"
        assert value == "(too large to be read)" or (value.endswith("...") and set(value) == {"x", "."})
