"""Launches of the learner's launch file, without and with arguments, and the facts gathered in them."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace

from tutor.exercise.launch_graph import (
    Pair,
    count_entities,
    describe_graph,
    find_pair,
    pairs,
    pairs_in_namespace,
    pairs_on_topic_named,
    shared_topics,
)
from tutor.exercise.nouns import LaunchFile
from tutor.exercise.quoted_messages import logs_of_messages
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.launch_output import ended_processes
from tutor.judge.trace import Ending, Trace
from tutor.judge.waiting_for_nodes import MESSAGE_GAP_S, OTHER_NAME_S, START_S
from tutor.ros_model import Graph

NODE_DELAY_S = 12.0
"""Time limit for the second node after the first, for example one that is started by a timer."""

HANDLER_DELAY_S = 4.0
"""Time limit for a node that is started by an event handler, for example because of what the first one has logged."""

ARGUMENTS_S = 0.7
"""Time limit for a pair that an argument asks for, once all that the launch starts is up."""

HANDLING_S = 0.3
"""A launch that handles the output of its nodes is done with it within this time. One that waits for a timer is not."""

CONNECT_S = 6.0
"""Time limit for a connecting endpoint once there are two nodes that share no topic yet."""

ENDPOINTS_S = 2.0
"""Time limit for publishers and subscriptions to be discovered once there are as many nodes as without arguments."""

EXIT_REPORT_S = 3.0
"""Time limit for the launch to report that a process has ended."""

ANSWERS_S = 8.0
"""Timeout of a service request: most nodes answer at once, one with slow callbacks takes some seconds."""

RESEND_S = 1.0
"""A request that was not answered within this time may be lost, and is sent again."""

LIST_PARAMETERS = "rcl_interfaces/srv/ListParameters"
"""The type of a service that every rclpy and rclcpp node offers by default."""

LOG_DELAY_S = 1.0
"""A subscriber that logs its messages does so within this time of receiving one."""


@dataclass(frozen=True)
class LaunchRun:
    """One launch. `command_lines`: those of all its processes, including `ros2 launch` itself.

    `hidden`: topics whose message type is not installed, so that their messages cannot be read. `answering`: the nodes
    that still answered a service request after messages had arrived. `disconnected`: a publisher and a subscription had
    matched, but one of them has gone since; `trace.graph` is then the graph from when they were matched.
    """

    trace: Trace
    arguments: Mapping[str, str] = field(default_factory=dict)
    command_lines: tuple[str, ...] = ()
    hidden: frozenset[str] = frozenset()
    answering: frozenset[str] = frozenset()
    ending: Ending | None = None
    disconnected: bool = False

    @property
    def typed(self) -> str:
        """The launch arguments as typed on the command line."""
        return " ".join(f"{name}:={value}" for name, value in self.arguments.items()) or "no arguments"

    def describe(self) -> str:
        """Who publishes and subscribes to what, or how the launch has ended without any node."""
        if not self.trace.graph.nodes:
            return "no node" + (f"; the launch ended with {self.trace.exit}" if self.trace.exit else "")
        return describe_graph(self.trace.graph)


@dataclass(frozen=True)
class Launch:
    """Launch without arguments, watch the nodes and their messages, then press Ctrl+C."""

    launch_file: LaunchFile

    async def __call__(self, bench: Bench) -> LaunchRun:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> LaunchRun:
        async with bench.launch(self.launch_file.file) as run:
            bench.report_progress(0.1, "launching without arguments")
            if await run.until(lambda: bool(run.graph.nodes), START_S) and await _wait_for_launch(
                run, lambda: find_pair(run.graph) is not None, settle_s=HANDLER_DELAY_S, limit_s=NODE_DELAY_S
            ):
                await _wait_for_launch(run, lambda: bool(pairs(run.graph)), settle_s=OTHER_NAME_S, limit_s=CONNECT_S)
            bench.report_progress(0.4, "listening to the nodes")
            met = run.graph
            hidden = _listen(run, shared_topics(met))
            await run.until(lambda: _has_heard_enough(run, hidden), MESSAGE_GAP_S)
            answering = await _find_answering(run)
            if pairs(met):  # DDS reports with some delay that a node is gone
                await run.until(lambda: bool(pairs(run.graph)) or bool(ended_processes(run.output)), EXIT_REPORT_S)
            trace, command_lines = run.trace(), run.command_lines()
            disconnected = bool(pairs(met)) and not pairs(trace.graph)
            bench.report_progress(0.8, "pressing Ctrl+C")
            ending = await run.interrupt()
            return LaunchRun(
                _with_best_graph(trace, met, pairs), {}, command_lines, hidden, answering, ending, disconnected
            )


@dataclass(frozen=True)
class LaunchWith:
    """Launch with arguments: with another topic, whose name is random, in a namespace, or both.

    `topic` and `namespace`: the names of these arguments, "" for one that is not given; `to`: the namespace.
    """

    launch_file: LaunchFile
    topic: str = ""
    namespace: str = ""
    to: str = ""

    async def __call__(self, bench: Bench) -> LaunchRun:
        arguments, find_wanted = self._wanted()
        default_run = asyncio.ensure_future(bench.facts(Launch(self.launch_file)))
        try:
            async with bench.launch(self.launch_file.file, arguments=arguments) as run:
                bench.report_progress(
                    0.1, "launching with " + " ".join(f"{name}:={value}" for name, value in arguments.items())
                )
                await run.until(
                    lambda: bool(find_wanted(run.graph)) or default_run.done(), START_S + NODE_DELAY_S + MESSAGE_GAP_S
                )
                if not find_wanted(run.graph):
                    expected = count_entities((await default_run).trace.graph)
                    await run.until(
                        lambda: bool(find_wanted(run.graph)) or _has_at_least(run.graph, expected), NODE_DELAY_S
                    )
                    await _wait_for_launch(
                        run, lambda: bool(find_wanted(run.graph)), settle_s=ARGUMENTS_S, limit_s=ENDPOINTS_S
                    )
                met = run.graph
                topics = {publisher.topic for publisher, _ in find_wanted(met)}
                hidden = _listen(run, topics)
                if topics and not hidden:
                    await run.until(lambda: any(run.samples_on(topic) for topic in topics), MESSAGE_GAP_S)
                # Give all other endpoints time to appear, too: some may be where they should not be.
                expected = count_entities((await default_run).trace.graph)
                await run.until(lambda: _has_at_least(run.graph, expected), ENDPOINTS_S)
                return LaunchRun(
                    _with_best_graph(run.trace(), met, find_wanted), arguments, run.command_lines(), hidden
                )
        finally:
            default_run.cancel()

    def _wanted(self) -> tuple[Mapping[str, str], Callable[[Graph], list[Pair]]]:
        """The arguments of a launch, and what finds the pairs that they ask for."""
        name = f"topic_{random.randrange(1000, 9999)}" if self.topic else ""  # no launch file can know it in advance
        arguments = {argument: value for argument, value in ((self.topic, name), (self.namespace, self.to)) if argument}
        if self.namespace:
            return arguments, lambda graph: pairs_in_namespace(graph, self.to, name)
        return arguments, lambda graph: pairs_on_topic_named(graph, name)


@dataclass(frozen=True)
class LaunchInAnother:
    """Launch in another namespace; None unless everything is in `first` by default."""

    launch: LaunchWith
    first: str

    async def __call__(self, bench: Bench) -> LaunchRun | None:
        default_run = await bench.facts(Launch(self.launch.launch_file))
        return await self.launch(bench) if pairs_in_namespace(default_run.trace.graph, self.first) else None


async def _wait_for_launch(run: Run, seen: Callable[[], bool], *, settle_s: float, limit_s: float) -> bool:
    """Wait until `seen()`; give up after `limit_s`, or once the launch has had nothing more to start for `settle_s`."""
    settled_since = settled_at = run.now()

    def has_settled() -> bool:
        nonlocal settled_since, settled_at
        now = run.now()
        if run.has_launched_all():
            settled_at = now
        elif now - settled_at > HANDLING_S:
            settled_since = now
        return now - settled_since >= settle_s

    await run.until(lambda: seen() or has_settled(), limit_s)
    return seen()


async def _find_answering(run: Run) -> frozenset[str]:
    """The nodes of the pairs that answer a service request."""
    able = set(run.graph.parameter_nodes)
    asked = sorted(able & {end.node for pair in pairs(run.graph) for end in pair})
    answers = await asyncio.gather(
        *(
            run.call(f"{node}/list_parameters", LIST_PARAMETERS, {}, limit_s=ANSWERS_S, resend_s=RESEND_S)
            for node in asked
        )
    )
    return frozenset(node for node, answer in zip(asked, answers, strict=True) if answer.response is not None)


def _with_best_graph(trace: Trace, met: Graph, find_wanted: Callable[[Graph], list[Pair]]) -> Trace:
    """The trace, with the earlier graph `met` if only that one has the wanted pairs: nodes may be gone by now."""
    return replace(trace, graph=met) if find_wanted(met) and not find_wanted(trace.graph) else trace


def _listen(run: Run, topics: Iterable[str]) -> frozenset[str]:
    """Subscribe to these topics, and return those whose message type is not installed."""
    types = {publisher.topic: publisher.type for publisher in run.graph.publishers}
    return frozenset(topic for topic in topics if not run.watch(topic, types[topic]))


def _has_heard_enough(run: Run, hidden: frozenset[str]) -> bool:
    """Whether the subscribers have logged a message, or have had enough time to."""
    found = pairs(run.graph)
    if any(logs_of_messages(pair, run.logs, run.samples_on(pair[0].topic)) for pair in found):
        return True
    samples = [sample for pair in found if pair[0].topic not in hidden for sample in run.samples_on(pair[0].topic)]
    return not found or any(run.now() - sample.received_at > LOG_DELAY_S for sample in samples)


def _has_at_least(graph: Graph, expected: tuple[int, int, int]) -> bool:
    return all(count >= least for count, least in zip(count_entities(graph), expected, strict=True))
