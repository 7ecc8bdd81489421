"""Provisional reports on a node that a check still waits for: facts, a likely cause, and no more than is known."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field, replace
from typing import Any

import pytest

from tests.checks.builders import CRASH, NODE_UP, exited, graph, log, samples, trace
from tests.engine.helpers import FILE, Scene, criterion, node
from tutor.content import LiveTopic, LiveView, load_course
from tutor.content.near_miss import near_misses
from tutor.engine import progress
from tutor.engine.progress import RunSnapshot, ScenarioProgress, SoFar, describe
from tutor.judge.bench import Bench
from tutor.judge.events import CriterionJudged, Progress
from tutor.judge.trace import Exit, LogRecord, OutputLine, Sample, Trace
from tutor.ros_model import Graph, ServiceEndpoint, TopicEndpoint

TOPIC, TYPE = "/sensor/temperature", "std_msgs/msg/Float64"
VIEW = LiveView(topics=(LiveTopic(TOPIC, TYPE),))
NO_NODES = graph(nodes=())
SPINS = "import rclpy\nrclpy.spin(node)\n"


def describe_text(seen: Trace, view: LiveView = VIEW, **more: Any) -> str:
    return describe(RunSnapshot(seen, {TOPIC: TYPE}, **more), view).text


def with_source(source: str, seen: Trace) -> Trace:
    return replace(seen, file="node.py", sources={"node.py": source})


PUBLISHES = with_source(
    "class N(Node):\n    def __init__(self):\n        self.p = self.create_publisher(Float64, 't', 10)\n"
    "        self.create_timer(1.0, self.tick)\n    def tick(self):\n        self.p.publish(Float64())\n"
    "node = N()\nrclpy.spin(node)\n",
    trace(graph=graph(publishers={TOPIC: TYPE})),
)


@pytest.mark.parametrize(
    ("seen", "expected"),
    [
        (trace(graph=NO_NODES), "the program runs, no node yet"),
        (trace(graph=NODE_UP), f"no publisher on {TOPIC} yet, /node is up"),
        (PUBLISHES, f"nothing published on {TOPIC} yet, /node is up"),
        (trace(*samples(TOPIC, 1.0), graph=graph(publishers={TOPIC: TYPE})), ""),
        (
            trace(graph=graph(publishers={TOPIC: "std_msgs/msg/Float32"})),
            f"likely wrong type: {TOPIC} has the type std_msgs/msg/Float32, not {TYPE}",
        ),
        (trace(exit=exited(0), graph=NO_NODES), "the program has ended, with exit code 0"),
        (
            with_source(PUBLISHES.sources["node.py"].replace("rclpy.spin(node)", "time.sleep(9)"), PUBLISHES),
            "likely no spin: /node is up, and the program never calls rclpy.spin()",
        ),
        (
            with_source(PUBLISHES.sources["node.py"].replace("self.p.publish(Float64())", "pass"), PUBLISHES),
            "likely nothing calls publish: line 3 makes a publisher, and nothing calls its publish(): "
            "self.p = self.create_publisher(Float64, 't', 10)",
        ),
    ],
)
def test_what_is_missing_is_reported_with_a_likely_cause_if_there_is_one(seen: Trace, expected: str) -> None:
    assert describe_text(seen) == expected


def test_only_an_exception_that_ended_the_program_is_a_likely_cause() -> None:
    ended = describe(RunSnapshot(trace(err=CRASH, exit=exited(1)), {TOPIC: TYPE}), VIEW)
    assert ended.likely
    assert "'Sensor' object has no attribute 'nothing'" in ended.text
    running = describe(RunSnapshot(trace(err=CRASH, graph=NODE_UP), {TOPIC: TYPE}), VIEW)
    assert not running.likely
    assert running.text.endswith("(node.py, line 12: self.nothing()); the program still runs")


def test_a_misspelled_name_is_a_likely_cause() -> None:
    assert describe_text(trace(graph=graph(publishers={"/sensor/temprature": TYPE}))).startswith(
        "likely wrong topic: there is /sensor/temprature, not /sensor/temperature"
    )
    services = LiveView(services=("/add", "/divide"))
    seen = trace(graph=graph(services={"/add": "a/srv/B", "/devide": "a/srv/B"}))
    assert describe(RunSnapshot(seen), services).text == "likely wrong name: /node serves /devide, not /divide"


def test_a_node_that_serves_what_is_asked_has_misspelled_nothing() -> None:
    asked = LiveView(services=("/sensor/get_state",))
    state, states = "/sensor/get_state", "/sensor/get_states"
    assert [miss.found for miss in near_misses(graph(services={states: "a/srv/B"}), asked)] == [states]
    assert list(near_misses(graph(services={state: "a/srv/B", states: "a/srv/B"}), asked)) == []
    assert list(near_misses(graph(publishers={TOPIC: TYPE, f"{TOPIC}s": TYPE}), VIEW)) == []


def test_a_hidden_fault_is_not_pointed_to() -> None:
    hidden = replace(VIEW, has_hidden_fault=True)
    misspelled = trace(graph=graph(publishers={"/sensor/temprature": TYPE}))
    assert list(near_misses(misspelled.graph, hidden)) == []
    assert not describe(RunSnapshot(misspelled, {TOPIC: TYPE}), hidden).likely
    assert [lesson.id for lesson in load_course().lessons if lesson.live.has_hidden_fault] == ["b1.7"]


def test_missing_services_and_subscriptions_are_reported() -> None:
    services = LiveView(services=("/add", "/subtract", "/multiply", "/divide"))
    assert describe(RunSnapshot(trace(graph=NODE_UP)), services).text == "no service or client yet, /node is up"
    one = trace(graph=graph(services={"/add": "a/srv/B"}))
    assert describe(RunSnapshot(one), services).text == "no service /subtract, /multiply and /divide yet, /node is up"
    assert describe(RunSnapshot(one, awaits_response=True), LiveView(services=("/add",))).text == (
        "no answer to a request yet, /node is up"
    )
    a_client = trace(graph=replace(NODE_UP, clients=(ServiceEndpoint("/add", "a/srv/B", "/node"),)))
    assert describe(RunSnapshot(a_client), services) == SoFar()
    subscribed = replace(NODE_UP, subscriptions=(TopicEndpoint(TOPIC, TYPE, "/node"),))
    assert describe(RunSnapshot(trace(graph=subscribed)), VIEW).text == (
        f"nothing logged yet, /node is up and subscribed to {TOPIC}"
    )
    assert describe(RunSnapshot(replace(trace(graph=subscribed), logs=(log("mean 3"),))), VIEW) == SoFar()
    namespaced = replace(NODE_UP, publishers=(TopicEndpoint(f"/robot1{TOPIC}", TYPE, "/robot1/node"),))
    assert describe(RunSnapshot(trace(graph=namespaced)), VIEW) == SoFar()
    other = replace(NODE_UP, subscriptions=(TopicEndpoint(TOPIC, "a/msg/B", "/node"),))
    assert describe(RunSnapshot(trace(graph=other)), VIEW).text.startswith("likely wrong type: ")


def test_silence_that_the_exercise_may_ask_for_has_no_cause() -> None:
    """A scenario may start one node as silent or slow, by its parameters, while another publishes."""
    seen = replace(PUBLISHES, graph=NODE_UP)
    assert describe_text(seen, published_elsewhere={TOPIC}) == f"no publisher on {TOPIC} yet, /node is up"
    wrong = trace(graph=graph(publishers={TOPIC: "std_msgs/msg/Float32"}))
    assert not describe(RunSnapshot(wrong, {TOPIC: TYPE}, published_elsewhere={TOPIC}), LiveView()).likely


@dataclass
class FakeRun:
    """A fake run with the facts that the test sets."""

    seen: Trace = field(default_factory=lambda: trace(graph=NO_NODES))
    interrupted_at: float | None = None
    awaits_response: bool = False
    traces: int = 0

    def peek_graph(self) -> Graph:  # not `graph`, which updates the run's last seen graph
        return self.seen.graph

    @property
    def exit(self) -> Exit | None:
        return self.seen.exit

    @property
    def output(self) -> tuple[OutputLine, ...]:
        return self.seen.output

    @property
    def logs(self) -> tuple[LogRecord, ...]:
        return self.seen.logs

    def samples_on(self, topic: str) -> tuple[Sample, ...]:
        return self.seen.samples_on(topic)

    def now(self) -> float:
        return 1000.0

    def trace_of(self, graph: Graph) -> Trace:
        self.traces += 1
        return replace(self.seen, graph=graph)


class Reports:
    """Records the reports of a ScenarioProgress, and waits for them."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(progress, "QUIET_WAIT_S", 0.05)
        monkeypatch.setattr(progress, "UPDATE_INTERVAL_S", 0.01)
        self.all: list[tuple[float, str, str]] = []
        self.progress = ScenarioProgress(self._record, VIEW, set())
        self.progress.report(0.1, "waiting")

    def _record(self, fraction: float, doing: str, so_far: SoFar) -> None:
        self.all.append((fraction, doing, so_far.text))

    def follow(self, run: FakeRun) -> Any:
        return self.progress.follow(run, {TOPIC: TYPE})  # type: ignore[arg-type]

    async def until(self, so_far: str) -> None:
        async with asyncio.timeout(20):
            while self.all[-1][2] != so_far:
                await asyncio.sleep(0.005)


async def test_a_long_wait_is_reported_and_diagnosed_once_per_change(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    reports, run = Reports(monkeypatch), FakeRun()
    async with reports.follow(run):
        await reports.until("the program runs, no node yet")
        run.seen = PUBLISHES
        await reports.until(f"nothing published on {TOPIC} yet, /node is up")
        traces = run.traces
        await asyncio.sleep(0.1)
        assert run.traces == traces
        reports.progress.report(0.5, "pressing Ctrl+C")
        assert reports.all[-1] == (0.5, "pressing Ctrl+C", "")  # the previous report was about the step before
        run.interrupted_at = 990.0
        await reports.until("it has not ended after Ctrl+C yet")
    assert reports.all[-1][2] == ""
    assert len(reports.all) == 6


async def test_a_programs_output_is_reported_in_one_short_line(monkeypatch: pytest.MonkeyPatch) -> None:
    reports = Reports(monkeypatch)
    crash = CRASH.replace("has no attribute", "\x1b[31mhas no" + " attribute" * 200)
    async with reports.follow(FakeRun(trace(err=crash, exit=exited(1)))), asyncio.timeout(20):
        while not reports.all[-1][2]:
            await asyncio.sleep(0.005)
    assert 100 < len(reports.all[-1][2]) <= 500
    assert reports.all[-1][2].isprintable()


async def test_of_several_runs_the_one_with_a_likely_cause_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    reports = Reports(monkeypatch)
    wrong = trace(graph=graph(publishers={TOPIC: "std_msgs/msg/Float32"}))
    async with reports.follow(FakeRun()), reports.follow(FakeRun(wrong)):
        await reports.until(f"likely wrong type: {TOPIC} has the type std_msgs/msg/Float32, not {TYPE}")
    assert reports.all[-1][2].startswith("likely wrong type")


async def test_a_likely_cause_is_reported_while_a_real_node_is_waited_for(scene: Scene) -> None:
    def reported() -> list[str]:
        return [event.so_far for event in scene.events if isinstance(event, Progress) and event.so_far]

    async def waits(bench: Bench) -> str:
        async with bench.start(FILE, watch={"/chatter": "std_msgs/msg/Float64"}) as run:
            bench.report_progress(0.1, "waiting for the first message")
            assert await run.until(lambda: any(each.startswith("likely") for each in reported()), 30)
            return "done"

    source = node('publisher = node.create_publisher(String, "chatter", 10)')
    await scene.judge(criterion("a", waits), source=source)
    assert reported()[-1] == "likely wrong type: /chatter has the type std_msgs/msg/String, not std_msgs/msg/Float64"
    (judged,) = (event for event in scene.events if isinstance(event, CriterionJudged))
    assert scene.events.index(judged) > max(n for n, e in enumerate(scene.events) if isinstance(e, Progress))
    assert judged.result.verdict.passed  # a provisional report does not affect the verdict
