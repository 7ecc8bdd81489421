"""I1.3: what is done to the node."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf
from typing import Any

from checks.i1_3.facts import (
    AFTER_ZERO,
    AFTERWARDS_S,
    ANSWER_S,
    CLIENT,
    CLIENT_S,
    EASY,
    LATER_S,
    LOG_S,
    NO_CLIENT_S,
    SERVER,
    SIGNS,
    STUCK_S,
    TYPE,
    ClientRun,
    Division,
    ServiceCalls,
    find_complaints,
    missing_services,
    right_result,
)
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.trace import CallAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import SETTLE_S, patience_s, wait_until_log_quiet, wait_until_seen
from tutor.ros_model import Graph, ServiceEndpoint

DYING_S = 10.0
"""A process whose node is going ends within this time."""

SAID_S = 0.3
"""What a node has to say of a call is logged within this time, each line after the other."""

MOST_SAID_S = 2.0
"""A node that goes on logging forever is not waited for longer than this."""


@repeat_if_doubtful
async def call_each_service(bench: Bench) -> ServiceCalls:
    """Call every service once as `ros2 service call` does, then press Ctrl+C."""
    async with bench.start(SERVER, expected_s=0.5) as run:
        bench.report_progress(0.1, "waiting for the four services")
        known = await _services(run)
        spins = await run.parameters(2.0) is not None
        met = run.graph
        there = [name for name in SIGNS if name not in missing_services(met.servers)]
        bench.report_progress(0.4, "calling each service")
        answers = await _ask(run, [(name, *EASY) for name in there])
        unanswered = next((answer for answer in answers if answer.response is None), None)
        trace = await _as_met(run, met, known)
        bench.report_progress(0.8, "pressing Ctrl+C")
        ended = await run.interrupt() if run.exit is None else None
    stuck = await _stuck(bench, unanswered) if unanswered and trace.exit is None else ()
    return ServiceCalls(trace, answers, spins, stuck, ended)


async def _services(run: Run) -> bool:
    """Wait for the four services; whether a node was there, if only for a moment."""
    known = False

    def all_there() -> bool:
        nonlocal known
        known = known or bool(run.graph.nodes)
        return not missing_services(run.graph.servers)

    def limit_s() -> float:
        there = [(each.name, each.type) for each in run.graph.servers if each.name not in SIGNS or each.type != TYPE]
        return min((patience_s(there, name, TYPE) for name in missing_services(run.graph.servers)), default=SETTLE_S)

    await wait_until_seen(run, all_there, settle_s=limit_s)
    return known


async def _as_met(run: Run, met: Graph, known: bool) -> Trace:
    """The facts after the calls; where one has killed the node, with the graph as met before.

    A node that goes takes its services along, one by one. `known`: there was one, even if it was gone when we looked.
    """
    trace = run.trace()
    gone = set(missing_services(trace.graph.servers)) - set(missing_services(met.servers))
    if trace.exit is None and not gone and (trace.graph.nodes or not (known or met.nodes)):
        return trace
    await run.wait_for_exit(DYING_S)
    return replace(run.trace(), graph=met)


async def _stuck(bench: Bench, unanswered: CallAnswer) -> tuple[Frame, ...]:
    """Ask the same once more, only to see where the node is while it does not answer."""
    async with bench.start(SERVER) as run:
        bench.report_progress(0.9, "looking where the node is stuck")
        await wait_until_seen(run, lambda: any(service.name == unanswered.service for service in run.graph.servers))
        await run.call(unanswered.service, TYPE, unanswered.request, limit_s=STUCK_S)
        return await run.dump_stacks()


async def call_with_random_operands(bench: Bench) -> ServiceCalls:
    """Calculate with operands by chance."""
    async with bench.start(SERVER, expected_s=0.3) as run:
        known = await _services(run)
        met = run.graph
        there = [name for name in SIGNS if name not in missing_services(met.servers)]
        bench.report_progress(0.3, "calculating with positive and negative numbers")
        chosen = operands()
        a, b = chosen[0]  # in the other order, too, which makes no whole quotient
        swapped = [(name, b, a) for name in there if name != "/divide"]
        answers = await _ask(run, [*((name, a, b) for name in there for a, b in chosen), *swapped])
        return ServiceCalls(await _as_met(run, met, known), answers)


async def _ask(run: Run, questions: Sequence[tuple[str, int, int]]) -> tuple[CallAnswer, ...]:
    """Call one after another; stop at one without an answer, since each further one would cost its limit."""
    answers: list[CallAnswer] = []
    for name, a, b in questions:
        answers.append(await run.call(name, TYPE, {"a": a, "b": b}, limit_s=ANSWER_S))
        if answers[-1].response is None:
            break
    return tuple(answers)


async def divide_by_zero(bench: Bench) -> Division:
    """Divide by zero, listen to what the node says, and go on calling."""
    async with bench.start(SERVER) as run:
        bench.report_progress(0.1, "waiting for /divide")
        if not await wait_until_seen(run, lambda: "/divide" not in missing_services(run.graph.servers)):
            return Division(run.trace())

        async def divide(a: int, b: int) -> CallAnswer:
            return await run.call("/divide", TYPE, {"a": a, "b": b}, limit_s=ANSWER_S)

        before = await divide(84, 7)
        await wait_until_log_quiet(run, quiet_s=SAID_S, most_s=MOST_SAID_S)
        ordinary = tuple(run.logs)
        bench.report_progress(0.4, "calling /divide: 10 ÷ 0")
        by_zero = await divide(10, 0)
        await run.until(lambda: bool(find_complaints(ordinary, run.logs[len(ordinary) :])), LOG_S)
        said = tuple(run.logs[len(ordinary) :])
        await run.until(lambda: run.exit is not None, AFTERWARDS_S)
        bench.report_progress(0.8, "calling /divide again")
        after = await _ask(run, [("/divide", a, b) for a, b in AFTER_ZERO])
        trace, silent = run.trace(), run.exit is None and not find_complaints(ordinary, said)
        at_end = (await run.interrupt()).output if silent else ()
        return Division(trace, before, by_zero, after, ordinary, said, at_end)


async def run_client(bench: Bench) -> ClientRun:
    """Run the client, and bring up our four servers when it has been there for a while."""
    if not bench.has_file(CLIENT):
        return ClientRun(None)
    async with bench.start(CLIENT, expected_s=2.0) as run:
        bench.report_progress(0.2, "running the client, before there is a server")
        clients: set[ServiceEndpoint] = set()  # what it had while it ran: afterwards, the graph no longer knows
        due_at = inf
        up_at: float | None = None
        lost_s = 0.0

        def look() -> None:
            nonlocal due_at, up_at, lost_s
            if run.exit is not None:
                return
            clients.update(run.graph.clients)
            if up_at is None:
                lost_s = run.node_cpu_wait_s() + run.our_cpu_wait_s() - our_wait_s
            if run.graph.nodes and due_at == inf:
                due_at = run.now() + NO_CLIENT_S + LATER_S
            if clients:
                due_at = min(due_at, run.now() + LATER_S)
            if up_at is None and run.now() >= due_at:
                bench.report_progress(0.4, "bringing up our servers")
                # /add comes last, for it is asked for first: a client that waits for that one alone finds the others,
                # too.
                for name in reversed(SIGNS):
                    run.serve(name, TYPE, _server(name))
                up_at = run.now()

        our_wait_s = run.our_cpu_wait_s()
        await run.wait_for_exit(CLIENT_S, meanwhile=look, all_sent=lambda: up_at is not None)
        watched_s = run.now() - run.started_at
        trace, served, ended = run.trace(), tuple(run.served), run.exit
        stuck = await run.dump_stacks() if ended is None else ()
        up_s = None if up_at is None else up_at - run.started_at
        return ClientRun(trace, served, ended, stuck, tuple(clients), up_s, lost_s, watched_s)


def operands() -> list[tuple[int, int]]:
    """Operands for each service, by chance, so that no answer can be known beforehand; a can be divided by b.

    With every combination of signs, with more than fits into 32 bits, and with 0. No result has more than 53 bits.
    """
    ordinary = [(sign * random.randint(20, 900), by) for by in (1, -1) for sign in (1, -1)]
    large = random.choice((1, -1)) * random.randint(2 * 10**9, 4 * 10**9)
    return [
        (times * divisor, divisor)
        for times, sign in (*ordinary, (large, 1), (0, 1))
        for divisor in [sign * random.randint(3, 19)]
    ]


def _server(service: str) -> Any:
    def answer(request: Mapping[str, Any]) -> Mapping[str, Any]:
        result = right_result(service, request["a"], request["b"])
        return {"sum": max(-(2**63), min(2**63 - 1, result))}

    return answer
