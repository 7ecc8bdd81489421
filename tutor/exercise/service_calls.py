"""Calls of the learner's services, made as `ros2 service call` makes them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from tutor.exercise.node_parameters import DumpSilentNode
from tutor.exercise.nouns import Program, Service
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.stuck_nodes import ask_unless_stuck
from tutor.judge.trace import CallAnswer, Ending, Trace
from tutor.judge.tracebacks import Frame, failed_outside_callbacks
from tutor.judge.waiting_for_nodes import SETTLE_S, patience_s, wait_until_seen
from tutor.ros_model import Graph, ServiceEndpoint

ANSWER_S = 5.0
"""Time limit for the answer to a service call."""

EXIT_LIMIT_S = 10.0
"""Time limit for a process to exit once its node has begun to disappear from the graph."""

END_S = 2.0
"""Time in which a server that no longer answers ends, if an exception in a callback has ended its spinning."""

SPIN_S = 2.0
"""A node that spins answers a parameter request within twice this time."""

STUCK_CALL_S = 1.5
"""Time given to a repeated, previously unanswered call before the node counts as stuck in it."""

Question = tuple[Service, tuple[Any, ...]]
"""A call to make: a service, and the values of its request's fields in their order."""


@dataclass(frozen=True)
class ServiceCalls:
    """The server's answers, in the order of the calls.

    `spins`: whether the node had answered a parameter call before. `stuck`: the node's stack, innermost frame first,
    during a call that it did not answer. `ready`: whether nothing but the calls can have ended the server, since it was
    up and, as far as can be seen, spinning when the first one was made. `gone`: the services that were there before the
    calls and no longer are, though the program runs on.
    """

    trace: Trace
    answers: tuple[CallAnswer, ...]
    spins: bool = True
    stuck: tuple[Frame, ...] = ()
    ending: Ending | None = None
    ready: bool = True
    gone: tuple[str, ...] = ()

    @property
    def ended_by_a_call(self) -> bool:
        """Whether a call ended the server, whether it was answered or not: that the answer gets out is a race."""
        if not self.ready or not self.answers or self.trace.exit is None:
            return False
        answered = any(answer.response is not None for answer in self.answers)
        return answered or not failed_outside_callbacks(self.trace)

    def of(self, service: str) -> tuple[CallAnswer, ...]:
        """The answers of one service."""
        return tuple(answer for answer in self.answers if answer.service == service)


@dataclass(frozen=True)
class Server:
    """A program that offers these services."""

    program: Program
    services: tuple[Service, ...]

    def missing(self, servers: Sequence[ServiceEndpoint]) -> list[Service]:
        """The services that are not offered with the required type."""
        offered = {(server.name, server.type) for server in servers}
        return [service for service in self.services if (service.name, service.type) not in offered]

    def gone(self, run: Run, graph_before: Graph) -> tuple[str, ...]:
        """The services that are no longer in the graph, though the program still runs."""
        return tuple(service.name for service in self._lost(run.graph, graph_before)) if run.exit is None else ()

    def _lost(self, graph: Graph, graph_before: Graph) -> list[Service]:
        """The services that were offered before, and no longer are."""
        before = self.missing(graph_before.servers)
        return [service for service in self.missing(graph.servers) if service not in before]

    async def wait(self, run: Run) -> bool:
        """Wait for the services. Return whether a node was up, if only for a moment."""
        had_node = False
        wanted = {(service.name, service.type) for service in self.services}

        def all_offered() -> bool:
            nonlocal had_node
            had_node = had_node or bool(run.graph.nodes)
            return not self.missing(run.graph.servers)

        def limit_s() -> float:
            present = [(server.name, server.type) for server in run.graph.servers]
            others = [server for server in present if server not in wanted]
            patience = (patience_s(others, service.name, service.type) for service in self.missing(run.graph.servers))
            return min(patience, default=SETTLE_S)

        await wait_until_seen(run, all_offered, settle_s=limit_s)
        return had_node

    async def trace_after_calls(self, run: Run, graph_before: Graph, had_node: bool) -> Trace:
        """Return the trace after calls; if one of them killed the node, with the graph from before the calls.

        The services of a dying node disappear one by one, so a missing one counts as a sign of its end.
        `had_node`: a node was up at some time, even if it is no longer in `graph_before`.
        """
        trace = run.trace()
        lost = self._lost(trace.graph, graph_before)
        if trace.exit is None and not lost and (trace.graph.nodes or not (had_node or graph_before.nodes)):
            return trace
        await run.wait_for_exit(EXIT_LIMIT_S)
        return replace(run.trace(), graph=graph_before)


async def make_calls(run: Run, questions: Sequence[Question], limit_s: float = ANSWER_S) -> tuple[CallAnswer, ...]:
    """Make the calls one after another; stop after an unanswered one, as each further one would time out too."""
    answers: list[CallAnswer] = []
    for service, given in questions:
        request = dict(zip(service.request, given, strict=True))
        answers.append(await run.call(service.name, service.type, request, limit_s=limit_s))
        if answers[-1].response is None:
            break
    return tuple(answers)


@dataclass(frozen=True)
class CallEach:
    """Call every service once, then press Ctrl+C. `given`: the values of each request's fields."""

    server: Server
    given: tuple[Any, ...]

    async def __call__(self, bench: Bench) -> ServiceCalls:
        return await repeat_chance_failures(self._run)(bench)

    async def _run(self, bench: Bench) -> ServiceCalls:
        server, file = self.server, self.server.program.file
        silent = DumpSilentNode(server.program)
        async with bench.start(file, expected_s=0.5) as run:
            bench.report_progress(0.1, "waiting for the services")
            had_node = await server.wait(run)
            parameters, is_stuck = await ask_unless_stuck(run, SPIN_S, lambda: bench.facts(silent))
            graph_before = run.graph
            missing = server.missing(graph_before.servers)
            offered = [service for service in server.services if service not in missing]
            bench.report_progress(0.4, "calling each service")
            limit_s = STUCK_CALL_S if is_stuck else ANSWER_S
            ready = run.exit is None and (parameters is not None or not graph_before.parameter_nodes)
            answers = await make_calls(run, [(service, self.given) for service in offered], limit_s)
            unanswered = next((answer for answer in answers if answer.response is None), None)
            if answers and not is_stuck:
                answered = {answer.service for answer in answers if answer.response is not None}
                await self._see_whether_it_ends(run, [s for s in offered if s.name in answered] or offered[1:])
            trace = await server.trace_after_calls(run, graph_before, had_node)
            gone = server.gone(run, graph_before)
            bench.report_progress(0.8, "pressing Ctrl+C")
            ended = await run.interrupt()
        stuck: tuple[Frame, ...] = ()
        if unanswered and trace.exit is None:
            stuck = await (bench.facts(silent) if is_stuck else self._dump_stuck_node(bench, unanswered))
        return ServiceCalls(trace, answers, parameters is not None, stuck, ended, ready, gone)

    async def _see_whether_it_ends(self, run: Run, services: Sequence[Service]) -> None:
        """Call on: a server that answers twice more has survived the calls before; else give it time to end.

        Twice, since a MultiThreadedExecutor raises the exception of a callback only when it is woken up the next time.
        """
        again = await make_calls(
            run, [(service, self.given) for service in services[:1] for _ in range(2)], STUCK_CALL_S
        )
        if run.exit is None and any(answer.response is None for answer in again):
            await run.wait_for_exit(END_S, all_sent=lambda: True)

    async def _dump_stuck_node(self, bench: Bench, unanswered: CallAnswer) -> tuple[Frame, ...]:
        """Repeat the unanswered call on another start to get a stack dump of the node while it does not answer."""
        service = next(service for service in self.server.services if service.name == unanswered.service)
        async with bench.start(self.server.program.file) as run:
            bench.report_progress(0.9, "looking where the node is stuck")
            await wait_until_seen(run, lambda: any(server.name == service.name for server in run.graph.servers))
            again = await run.call(service.name, service.type, unanswered.request, limit_s=STUCK_CALL_S)
            if again.response is not None:  # another callback, such as that of a timer, has not got stuck yet
                await run.until(lambda: run.exit is not None, STUCK_CALL_S)
                await run.call(service.name, service.type, unanswered.request, limit_s=STUCK_CALL_S)
            return await run.dump_stacks()


@dataclass(frozen=True)
class MakeCalls:
    """Make the calls that `questions` returns, apart from those of services that are not there."""

    server: Server
    questions: Callable[[], Sequence[Question]]

    async def __call__(self, bench: Bench) -> ServiceCalls:
        server = self.server
        async with bench.start(server.program.file, expected_s=0.3) as run:
            had_node = await server.wait(run)
            graph_before = run.graph
            missing = server.missing(graph_before.servers)
            bench.report_progress(0.3, "calling the services with many requests")
            questions = [question for question in self.questions() if question[0] not in missing]
            answers = await make_calls(run, questions)
            trace = await server.trace_after_calls(run, graph_before, had_node)
            return ServiceCalls(trace, answers, gone=server.gone(run, graph_before))


def right_result(service: Service, request: Mapping[str, Any]) -> Any:
    """The right value of the response's field; None where any answer is right."""
    assert service.computes is not None
    return service.computes(*(request[name] for name in service.request))


def describe_request(service: Service, request: Mapping[str, Any]) -> str:
    """A request in few words: "6 + 3", or "width=2, height=3"."""
    if service.sign and len(service.request) == 2:
        return f" {service.sign} ".join(str(request[name]) for name in service.request)
    return ", ".join(f"{name}={value}" for name, value in request.items())


def describe_answers(services: Sequence[Service], answers: Sequence[CallAnswer], joined: str = "=") -> list[str]:
    """Each answered call with its result, such as "6 + 3 = 9"."""
    by_name = {service.name: service for service in services}
    return [
        f"{describe_request(by_name[a.service], a.request)} {joined} {a.response[by_name[a.service].response]}"
        for a in answers
        if a.response is not None
    ]
