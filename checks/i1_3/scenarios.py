"""I1.3: the scenarios, which start the nodes and gather the facts."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf
from typing import Any

from checks.i1_3.facts import (
    ANSWER_S,
    CLIENT,
    CLIENT_S,
    DELAYED_EXIT_S,
    DIVISIONS_AFTER_ZERO,
    EASY_OPERANDS,
    GOOD_DIVISIONS,
    LOG_DELAY_S,
    NO_CLIENT_GRACE_S,
    NO_PROGRESS_S,
    OPERATOR_SIGNS,
    SERVER,
    SERVER_DELAY_S,
    STUCK_CALL_S,
    TYPE,
    ClientRun,
    Division,
    ServiceCalls,
    correct_result,
    find_complaints,
    missing_services,
)
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.stuck import StuckTest, ask_unless_stuck
from tutor.judge.trace import CallAnswer, LogRecord, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import IDLE_S, SETTLE_S, find_stuck_frames, patience_s, wait_until_log_quiet, wait_until_seen
from tutor.ros_model import Graph, ServiceEndpoint

EXIT_LIMIT_S = 10.0
"""Time limit for a process to exit once its node has begun to disappear from the graph."""

END_S = 2.0
"""Time in which a server that no longer answers ends, if an exception in a callback has ended its spinning."""

SPIN_S = 2.0
"""A node that spins answers a parameter request within twice this time."""

LOG_QUIET_S = 0.3
"""Silence after which a node counts as done logging about a call: longer than between two of its messages."""

MAX_LOG_WAIT_S = 2.0
"""Longest wait for that silence, for a node that never stops logging."""


@repeat_if_doubtful
async def call_each_service(bench: Bench) -> ServiceCalls:
    """Call every service once as `ros2 service call` does, then press Ctrl+C."""
    async with bench.start(SERVER, expected_s=0.5) as run:
        bench.report_progress(0.1, "waiting for the four services")
        had_node = await _wait_for_services(run)
        parameters, is_stuck = await ask_unless_stuck(run, SPIN_S, lambda: bench.facts(_dump_silent_server))
        graph_before = run.graph
        offered = [name for name in OPERATOR_SIGNS if name not in missing_services(graph_before.servers)]
        bench.report_progress(0.4, "calling each service")
        limit_s = STUCK_CALL_S if is_stuck else ANSWER_S
        ready = run.exit is None and (parameters is not None or not graph_before.parameter_nodes)
        answers = await _make_calls(run, [(name, *EASY_OPERANDS) for name in offered], limit_s)
        unanswered = next((answer for answer in answers if answer.response is None), None)
        if answers and not is_stuck:
            await _see_whether_it_ends(run, [a.service for a in answers if a.response is not None] or offered[1:])
        trace = await _trace_after_calls(run, graph_before, had_node)
        bench.report_progress(0.8, "pressing Ctrl+C")
        ended = await run.interrupt()
    stuck: tuple[Frame, ...] = ()
    if unanswered and trace.exit is None:
        stuck = await (bench.facts(_dump_silent_server) if is_stuck else _dump_stuck_node(bench, unanswered))
    return ServiceCalls(trace, answers, parameters is not None, stuck, ended, ready)


async def _dump_silent_server(bench: Bench) -> tuple[Frame, ...]:
    return await find_stuck_frames(bench, SERVER)


async def _wait_for_services(run: Run) -> bool:
    """Wait for the four services. Return whether a node was up, if only for a moment."""
    had_node = False

    def all_offered() -> bool:
        nonlocal had_node
        had_node = had_node or bool(run.graph.nodes)
        return not missing_services(run.graph.servers)

    def limit_s() -> float:
        others = [
            (each.name, each.type) for each in run.graph.servers if each.name not in OPERATOR_SIGNS or each.type != TYPE
        ]
        return min((patience_s(others, name, TYPE) for name in missing_services(run.graph.servers)), default=SETTLE_S)

    await wait_until_seen(run, all_offered, settle_s=limit_s)
    return had_node


async def _see_whether_it_ends(run: Run, services: Sequence[str]) -> None:
    """Call on: a server that answers twice more has survived the calls before; else give it time to end.

    Twice, since a MultiThreadedExecutor raises the exception of a callback only when it is woken up the next time.
    """
    again = await _make_calls(run, [(name, *EASY_OPERANDS) for name in services[:1] for _ in range(2)], STUCK_CALL_S)
    if run.exit is None and any(answer.response is None for answer in again):
        await run.wait_for_exit(END_S, all_sent=lambda: True)


async def _trace_after_calls(run: Run, graph_before: Graph, had_node: bool) -> Trace:
    """Return the trace after the calls; if one of them killed the node, with the graph from before the calls.

    The services of a dying node disappear one by one, so a missing one counts as a sign of its end.
    `had_node`: a node was up at some time, even if it is no longer in `graph_before`.
    """
    trace = run.trace()
    lost = set(missing_services(trace.graph.servers)) - set(missing_services(graph_before.servers))
    if trace.exit is None and not lost and (trace.graph.nodes or not (had_node or graph_before.nodes)):
        return trace
    await run.wait_for_exit(EXIT_LIMIT_S)
    return replace(run.trace(), graph=graph_before)


async def _dump_stuck_node(bench: Bench, unanswered: CallAnswer) -> tuple[Frame, ...]:
    """Repeat the unanswered call on another start to get a stack dump of the node while it does not answer."""
    async with bench.start(SERVER) as run:
        bench.report_progress(0.9, "looking where the node is stuck")
        await wait_until_seen(run, lambda: any(service.name == unanswered.service for service in run.graph.servers))
        await run.call(unanswered.service, TYPE, unanswered.request, limit_s=STUCK_CALL_S)
        return await run.dump_stacks()


async def call_with_random_operands(bench: Bench) -> ServiceCalls:
    """Call every service with random operands."""
    async with bench.start(SERVER, expected_s=0.3) as run:
        had_node = await _wait_for_services(run)
        graph_before = run.graph
        offered = [name for name in OPERATOR_SIGNS if name not in missing_services(graph_before.servers)]
        bench.report_progress(0.3, "calculating with positive and negative numbers")
        chosen = random_operands()
        # Swapped as well, but not to divide: the quotient would not be a whole number, or the divisor is 0.
        swapped = [(name, b, a) for name in offered if name != "/divide" for a, b in (chosen[0], chosen[-1])]
        answers = await _make_calls(run, [*((name, a, b) for name in offered for a, b in chosen), *swapped])
        return ServiceCalls(await _trace_after_calls(run, graph_before, had_node), answers)


async def _make_calls(
    run: Run, questions: Sequence[tuple[str, int, int]], limit_s: float = ANSWER_S
) -> tuple[CallAnswer, ...]:
    """Make the calls one after another; stop after an unanswered one, as each further one would time out too."""
    answers: list[CallAnswer] = []
    for name, a, b in questions:
        answers.append(await run.call(name, TYPE, {"a": a, "b": b}, limit_s=limit_s))
        if answers[-1].response is None:
            break
    return tuple(answers)


async def divide_by_zero(bench: Bench) -> Division:
    """Divide by zero, watch what the node logs, and go on calling."""
    async with bench.start(SERVER) as run:
        bench.report_progress(0.1, "waiting for /divide")
        if not await wait_until_seen(run, lambda: "/divide" not in missing_services(run.graph.servers)):
            return Division(run.trace())

        before, *again = await _make_calls(run, [("/divide", 84, 7)] * GOOD_DIVISIONS)
        if any(answer.response is None for answer in (before, *again)):
            return Division(run.trace(), before, tuple(again))
        await wait_until_log_quiet(run, quiet_s=LOG_QUIET_S, max_s=MAX_LOG_WAIT_S)
        bench.report_progress(0.4, "calling /divide: 10 ÷ 0")
        since = run.now()  # messages about the good divisions may still be on their way to us

        def find_logs() -> tuple[tuple[LogRecord, ...], tuple[LogRecord, ...]]:
            earlier = tuple(each for each in run.logs if each.stamp < since)
            return earlier, tuple(each for each in run.logs if each.stamp >= since)

        (by_zero,) = await _make_calls(run, [("/divide", 10, 0)])
        await run.until(lambda: bool(find_complaints(*find_logs())), LOG_DELAY_S, idle_s=IDLE_S)
        ordinary, logged = find_logs()
        await run.until(lambda: run.exit is not None, DELAYED_EXIT_S)
        bench.report_progress(0.8, "calling /divide again")
        after = await _make_calls(run, [("/divide", a, b) for a, b in DIVISIONS_AFTER_ZERO])
        trace = run.trace()
        ended = await run.interrupt() if not find_complaints(ordinary, logged) else None
        at_end = ended.output if ended else ()
        return Division(trace, before, tuple(again), by_zero, after, ordinary, logged, at_end)


async def run_client(bench: Bench) -> ClientRun:
    """Run the client, and bring up our four servers a little later."""
    if not bench.has_file(CLIENT):
        return ClientRun(None)
    async with (
        bench.start(CLIENT, expected_s=2.0) as run,
        StuckTest(run, lambda: bench.facts(_dump_silent_client)) as test,
    ):
        bench.report_progress(0.2, "running the client, before there is a server")
        watch = _ClientWatch(bench, run, test)
        await run.wait_for_exit(
            CLIENT_S, meanwhile=watch.look, all_sent=lambda: watch.up_at is not None, given_up=test.is_stuck
        )
        watched_s = run.now() - run.started_at
        trace, served, ended = run.trace(), tuple(run.served), run.exit
        stuck = await run.dump_stacks() if ended is None else ()
        up_s = None if watch.up_at is None else watch.up_at - run.started_at
        return ClientRun(trace, served, ended, stuck, tuple(watch.clients), up_s, watch.cpu_wait_s, watched_s)


class _ClientWatch:
    """Brings up our servers some time after the client has begun to look for them, and sees whether it gets on.

    `clients`: its service clients, gathered as it runs, since the graph forgets them when it exits. `up_at`: when our
    servers came up. `cpu_wait_s`: for how long the client, or we, waited for a CPU until then.
    """

    def __init__(self, bench: Bench, run: Run, test: StuckTest) -> None:
        self._bench, self._run, self._test = bench, run, test
        self._our_wait_s = run.our_cpu_wait_s()
        self._due_at = inf
        self._progress, self._progress_at = 0, 0.0
        self.clients: set[ServiceEndpoint] = set()
        self.up_at: float | None = None
        self.cpu_wait_s = 0.0

    def look(self) -> None:
        """Take in new facts, and act on them."""
        run = self._run
        if run.exit is not None:
            return
        self.clients.update(run.graph.clients)
        if self.up_at is None:
            self.cpu_wait_s = run.node_cpu_wait_s() + run.our_cpu_wait_s() - self._our_wait_s
        if run.graph.nodes and self._due_at == inf:
            self._due_at = run.now() + NO_CLIENT_GRACE_S + SERVER_DELAY_S
        if self.clients:
            self._due_at = min(self._due_at, run.now() + SERVER_DELAY_S)
        if self.up_at is None and run.now() >= self._due_at:
            self._bench.report_progress(0.4, "bringing up our servers")
            _serve_all(run)
            self.up_at = self._progress_at = run.now()
        if (progress := len(run.served) + len(run.output)) != self._progress:
            self._progress, self._progress_at = progress, run.now()
        if self.up_at is not None and run.now() - self._progress_at >= NO_PROGRESS_S:
            self._test.start()


async def _dump_silent_client(bench: Bench) -> tuple[Frame, ...]:
    """Start the client once more, with our servers up, only to see where it is when it goes on no longer."""
    async with bench.start(CLIENT) as run:
        bench.report_progress(0.9, "looking where the client is stuck")
        _serve_all(run)
        await wait_until_seen(run, lambda: bool(run.served))
        await run.until(lambda: run.exit is not None, STUCK_CALL_S)
        return await run.dump_stacks() if run.exit is None else ()


def _serve_all(run: Run) -> None:
    # /add comes up last, because clients ask for it first: one that waits for /add alone then finds the others as well.
    for name in reversed(OPERATOR_SIGNS):
        run.serve(name, TYPE, _server(name))


def random_operands() -> list[tuple[int, int]]:
    """Return random pairs (a, b), so that no answer can be hard-coded; a is a multiple of b.

    They cover every combination of signs, values beyond 32 bits, and a = 0. No result has more than 53 bits.
    """
    ordinary = [(sign * random.randint(20, 900), by) for by in (1, -1) for sign in (1, -1)]
    large = random.choice((1, -1)) * random.randint(2 * 10**9, 4 * 10**9)
    return [
        (quotient * divisor, divisor)
        for quotient, sign in (*ordinary, (large, 1), (0, 1))
        for divisor in [sign * random.randint(3, 19)]
    ]


def _server(service: str) -> Any:
    def answer(request: Mapping[str, Any]) -> Mapping[str, Any]:
        result = correct_result(service, request["a"], request["b"])
        return {"sum": max(-(2**63), min(2**63 - 1, result))}

    return answer
