"""I2.2: what is done with the launch file."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from checks.i2_2.facts import (
    ANOTHER,
    FILE,
    NAMESPACE,
    LaunchRun,
    Pair,
    count_entities,
    find_pair,
    logs_of_messages,
    pairs,
    pairs_in_namespace,
    pairs_on_topic_named,
    shared_topics,
)
from checks.i2_2.processes import ended_processes
from tutor.judge.bench import Bench, Run
from tutor.judge.trace import Trace
from tutor.judge.waiting import RARE_S, START_S
from tutor.ros_model import Graph

DELAYED_S = 12.0
"""A node may be started this much later than the first one, by a timer say."""

MORE_S = 6.0
"""Where two nodes are there, but share no topic, what joins them may come this much later."""

ENDPOINTS_S = 2.0
"""When as many nodes are there as without arguments, their publishers and subscriptions are there within this time."""

GONE_S = 3.0
"""A launch tells that a process has ended within this time."""

ANSWERS_S = 12.0
"""A node whose callbacks take some seconds answers a request within this time; most do at once."""

LIST_PARAMETERS = "rcl_interfaces/srv/ListParameters"
"""What every node of rclpy's and rclcpp's can be asked."""

SILENT_S = 1.0
"""A subscriber that logs what it gets does so within this time."""


async def plain(bench: Bench) -> LaunchRun:
    """Launch without arguments, see the nodes and whether they talk, then press Ctrl+C."""
    async with bench.launch(FILE) as run:
        bench.report_progress(0.1, "launching without arguments")
        if await run.until(lambda: bool(run.graph.nodes), START_S) and await run.until(
            lambda: find_pair(run.graph) is not None, DELAYED_S
        ):
            await run.until(lambda: bool(pairs(run.graph)), MORE_S)
        bench.report_progress(0.4, "listening to the nodes")
        met = run.graph
        hidden = _listen(run, shared_topics(met))
        await run.until(lambda: _wait_until_quiet(run, hidden), RARE_S)
        answering = await _answering(run)
        if pairs(met):  # DDS reports a node that has gone a little later
            await run.until(lambda: bool(pairs(run.graph)) or bool(ended_processes(run.output)), GONE_S)
        trace, command_lines = run.trace(), await run.command_lines()
        parted = bool(pairs(met)) and not pairs(trace.graph)
        bench.report_progress(0.8, "pressing Ctrl+C")
        ending = await run.interrupt() if run.exit is None else None
        return LaunchRun(_with(trace, met, pairs), {}, command_lines, hidden, answering, ending, parted)


async def other_topic(bench: Bench) -> LaunchRun:
    """Launch with another topic."""
    name = _name()
    return await _varied(bench, {"topic": name}, lambda graph: pairs_on_topic_named(graph, name))


async def other_namespace(bench: Bench) -> LaunchRun:
    """Launch in a namespace."""
    return await _varied(bench, {"namespace": NAMESPACE}, pairs_in_namespace)


async def another_namespace(bench: Bench) -> LaunchRun | None:
    """Launch in yet another namespace; nothing, where what is there without arguments is not in the first one."""
    if not pairs_in_namespace((await bench.facts(plain)).trace.graph):
        return None
    return await _varied(bench, {"namespace": ANOTHER}, lambda graph: pairs_in_namespace(graph, space=ANOTHER))


async def both(bench: Bench) -> LaunchRun:
    """Launch with another topic, in a namespace."""
    name = _name()
    return await _varied(bench, {"topic": name, "namespace": NAMESPACE}, lambda graph: pairs_in_namespace(graph, name))


async def _varied(bench: Bench, arguments: Mapping[str, str], wanted: Callable[[Graph], list[Pair]]) -> LaunchRun:
    """Launch with arguments, until the nodes use what is wanted, or as much is there as without arguments."""
    usual = asyncio.ensure_future(bench.facts(plain))
    try:
        async with bench.launch(FILE, arguments=arguments) as run:
            bench.report_progress(
                0.1, "launching with " + " ".join(f"{name}:={value}" for name, value in arguments.items())
            )
            await run.until(lambda: bool(wanted(run.graph)) or usual.done(), START_S + DELAYED_S + RARE_S)
            if not wanted(run.graph):
                expected = count_entities((await usual).trace.graph)
                await run.until(lambda: bool(wanted(run.graph)) or _wait_at_least(run.graph, expected), DELAYED_S)
                await run.until(lambda: bool(wanted(run.graph)), ENDPOINTS_S)
            met = run.graph
            topics = _topics(wanted(met))
            hidden = _listen(run, topics)
            if topics and not hidden:
                await run.until(lambda: any(run.samples_on(topic) for topic in topics), RARE_S)
            # Whatever else there is without arguments must have had its time, too: it may be where it should not.
            expected = count_entities((await usual).trace.graph)
            await run.until(lambda: _wait_at_least(run.graph, expected), ENDPOINTS_S)
            return LaunchRun(_with(run.trace(), met, wanted), arguments, await run.command_lines(), hidden)
    finally:
        usual.cancel()


async def _answering(run: Run) -> frozenset[str]:
    """The nodes of the pairs that answer a request."""
    able = set(run.graph.parameter_nodes)
    asked = sorted(able & {end.node for pair in pairs(run.graph) for end in pair})
    answers = await asyncio.gather(
        *(run.call(f"{node}/list_parameters", LIST_PARAMETERS, {}, limit_s=ANSWERS_S) for node in asked)
    )
    return frozenset(node for node, answer in zip(asked, answers, strict=True) if answer.response is not None)


def _with(trace: Trace, met: Graph, wanted: Callable[[Graph], list[Pair]]) -> Trace:
    """The trace, with the graph as it was when the nodes met, should they be gone by now."""
    return replace(trace, graph=met) if wanted(met) and not wanted(trace.graph) else trace


def _listen(run: Run, topics: Iterable[str]) -> frozenset[str]:
    """Collect the messages of these topics; gives those whose type this ROS does not have."""
    types = {each.topic: each.type for each in run.graph.publishers}
    return frozenset(topic for topic in topics if not run.watch(topic, types[topic]))


def _wait_until_quiet(run: Run, hidden: frozenset[str]) -> bool:
    """Whether there is a message on each shared topic, and whether its subscribers have logged it, or will not."""
    found = pairs(run.graph)
    if any(logs_of_messages(pair, run.logs, run.samples_on(pair[0].topic)) for pair in found):
        return True
    samples = [sample for pair in found if pair[0].topic not in hidden for sample in run.samples_on(pair[0].topic)]
    return not found or any(run.now() - sample.received_at > SILENT_S for sample in samples)


def _topics(found: Iterable[Pair]) -> set[str]:
    return {one.topic for one, _ in found}


def _wait_at_least(graph: Graph, expected: tuple[int, int, int]) -> bool:
    return all(here >= wanted for here, wanted in zip(count_entities(graph), expected, strict=True))


def _name() -> str:
    """A topic that no launch file can know beforehand."""
    return f"topic_{random.randrange(1000, 9999)}"
