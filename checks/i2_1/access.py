"""I2.1: how the scenarios find the node, wait for it, and read its parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from checks.i2_1.facts import ANSWER_S, DEFAULT_HZ, DEFAULTS, FILE, MESSAGE_GAP_S, RATE, TOPIC, TYPE, find_parameter
from tutor.judge.bench import Bench, Run
from tutor.judge.stuck import ask_unless_stuck
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import RESENT_S, START_S, find_stuck_frames, wait_for_message, wait_for_publisher


async def dump_silent_node(bench: Bench) -> tuple[Frame, ...]:
    """Start without parameters and return the node's stack while it answers nothing."""
    return await find_stuck_frames(bench, FILE)


async def dump_if_stuck(bench: Bench, trace: Trace, answering: bool = False) -> tuple[Frame, ...]:
    """Return the stack of a node that, according to this trace, is up but does nothing and answers nothing; else ()."""
    return await bench.facts(dump_silent_node) if trace.graph.nodes and trace.exit is None and not answering else ()


async def find_node(bench: Bench, run: Run) -> str | None:
    """Find the node to talk to: the one with most of the required parameters. None if no node answers."""
    if not await run.until(lambda: bool(run.graph.parameter_nodes), START_S, idle_s=RESENT_S):
        return None
    declared, _ = await ask_unless_stuck(run, ANSWER_S, lambda: bench.facts(dump_silent_node))
    if declared is None:
        return None
    holders = [parameter.node for parameter in declared if parameter.name in DEFAULTS]
    return max(holders or run.graph.parameter_nodes, key=holders.count, default=None)


async def wait_until_publishing(bench: Bench, run: Run) -> tuple[str | None, bool]:
    """Return the node to talk to once it publishes (None if it does not), and whether it answers."""
    node = await find_node(bench, run)
    publishes = node is not None and await wait_for_message(run, TOPIC, TYPE, message_gap_s=MESSAGE_GAP_S)
    return (node if publishes else None), node is not None


async def wait_until_ready(bench: Bench, run: Run, *, at_once: bool) -> str | None:
    """Return the node to talk to once it publishes, or with `at_once`, as soon as it has its publisher.

    None if no node answers.
    """
    node = await find_node(bench, run)
    if node is not None and not at_once:
        await wait_for_message(run, TOPIC, TYPE, message_gap_s=MESSAGE_GAP_S)
    elif node is not None:
        await wait_for_publisher(run, TOPIC, TYPE)
    return node


def has_publisher(run: Run) -> bool:
    """Whether there is a publisher on the topic, of whatever type."""
    return any(publisher.topic == TOPIC for publisher in run.graph.publishers)


async def read_parameters(run: Run, names: Sequence[str]) -> tuple[Any, ...]:
    """Read these parameters; None for each that the node does not have."""
    declared = await run.parameters(ANSWER_S) or ()
    found = [find_parameter(declared, name) for name in names]
    return tuple(parameter.value if parameter else None for parameter in found)


async def read_base_hz(run: Run) -> float:
    """Read the rate that the node starts at: 1.0 Hz, or a wrong default from 0.5 to 10 Hz."""
    value = (await read_parameters(run, (RATE,)))[0]
    return float(value) if isinstance(value, (int, float)) and 0.5 <= value <= 10 else DEFAULT_HZ
