"""A run of the learner's client against servers of ours, which come up a little later."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import inf
from typing import Any

from tutor.exercise.nouns import Program, Service
from tutor.exercise.service_calls import STUCK_CALL_S, right_result
from tutor.judge.bench import Bench, Run
from tutor.judge.peers import Handler
from tutor.judge.stuck_nodes import StuckTest
from tutor.judge.trace import Exit, ServedRequest, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting_for_nodes import wait_until_seen
from tutor.ros_model import ServiceEndpoint

SERVER_DELAY_S = 0.7
"""Delay from the first service client to our servers coming up, about a second after the program's start.

A client that does not wait has sent its request by then; one that waits in steps of a second still finds them.
"""

NO_CLIENT_GRACE_S = 1.0
"""Grace period for a node without a service client: it may look for our servers before it creates one."""

NO_PROGRESS_S = 1.0
"""A client that has sent and printed nothing for so long may be stuck: another start tells."""

MIN_CPU_WAIT_S = 0.15
"""CPU wait from which a client that exited is run again before it is reported to have given up too early."""

MIN_CPU_WAIT_AT_LIMIT_S = 2.0
"""The same for a client still running at the time limit: it has had some 13 s, less this, to find our servers."""


@dataclass(frozen=True)
class ClientRun:
    """A run of the client against our servers; `trace` is None if the submission has no client.

    `stuck`: the stack, innermost frame first, of a client that did not exit within `watched_s`. `clients`: its service
    clients. `up_s`: the time from its start until our servers came up, None if it had exited by then. `cpu_wait_s`: how
    long the client, or we, waited for a CPU until our servers were up.
    """

    trace: Trace | None
    served: tuple[ServedRequest, ...] = ()
    exit: Exit | None = None
    stuck: tuple[Frame, ...] = ()
    clients: tuple[ServiceEndpoint, ...] = ()
    up_s: float | None = None
    cpu_wait_s: float = 0.0
    watched_s: float = inf

    @property
    def slowed(self) -> bool:
        """Whether the machine may be to blame if the client did not find our servers.

        A client with incompatible QoS would not have found them on an idle machine either.
        """
        never_met = any(
            client.reliability == "best_effort" or client.durability == "transient_local" for client in self.clients
        )
        if self.served or never_met:
            return False
        return self.cpu_wait_s >= (MIN_CPU_WAIT_S if self.exit is not None else MIN_CPU_WAIT_AT_LIMIT_S)


@dataclass(frozen=True)
class DumpSilentClient:
    """Start the client once more, with our servers up, only to see where it is when it goes on no longer."""

    client: Program
    services: tuple[Service, ...]

    async def __call__(self, bench: Bench) -> tuple[Frame, ...]:
        async with bench.start(self.client.file) as run:
            bench.report_progress(0.9, "looking where the client is stuck")
            _serve_all(run, self.services)
            await wait_until_seen(run, lambda: bool(run.served))
            await run.until(lambda: run.exit is not None, STUCK_CALL_S)
            return await run.dump_stacks() if run.exit is None else ()


@dataclass(frozen=True)
class RunClient:
    """Run the client, and bring up our servers a little later. `within_s`: how long it may take, in seconds."""

    client: Program
    services: tuple[Service, ...]
    within_s: float

    async def __call__(self, bench: Bench) -> ClientRun:
        if not bench.has_file(self.client.file):
            return ClientRun(None)
        silent = DumpSilentClient(self.client, self.services)
        async with (
            bench.start(self.client.file, expected_s=2.0) as run,
            StuckTest(run, lambda: bench.facts(silent)) as test,
        ):
            bench.report_progress(0.2, "running the client, before there is a server")
            watch = ClientWatch(bench, run, test, lambda: _serve_all(run, self.services), lambda: len(run.served))
            await run.wait_for_exit(
                self.within_s, meanwhile=watch.look, all_sent=lambda: watch.up_at is not None, given_up=test.is_stuck
            )
            watched_s = run.now() - run.started_at
            trace, served, ended = run.trace(), tuple(run.served), run.exit
            stuck = await run.dump_stacks() if ended is None else ()
            up_s = None if watch.up_at is None else watch.up_at - run.started_at
            return ClientRun(trace, served, ended, stuck, tuple(watch.clients), up_s, watch.cpu_wait_s, watched_s)


class ClientWatch:
    """Brings up our servers some time after the client has begun to look for them, and sees whether it gets on.

    `bring_up`: lets our servers appear. `answered`: how much they have answered so far.

    `clients`: its service clients, gathered as it runs, since the graph forgets them when it exits. `up_at`: when our
    servers came up. `cpu_wait_s`: for how long the client, or we, waited for a CPU until then.
    """

    def __init__(
        self, bench: Bench, run: Run, test: StuckTest, bring_up: Callable[[], None], answered: Callable[[], int]
    ) -> None:
        self._bench, self._run, self._test = bench, run, test
        self._bring_up, self._answered = bring_up, answered
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
            self._bring_up()
            self.up_at = self._progress_at = run.now()
        if (progress := self._answered() + len(run.output)) != self._progress:
            self._progress, self._progress_at = progress, run.now()
        if self.up_at is not None and run.now() - self._progress_at >= NO_PROGRESS_S:
            self._test.start()


def _serve_all(run: Run, services: tuple[Service, ...]) -> None:
    # The first comes up last, because clients ask for it first: one that waits for it alone then finds the others too.
    for service in reversed(services):
        run.serve(service.name, service.type, _handler(service))


def _handler(service: Service) -> Handler:
    """Answers a request with the right result, kept within 64 bits, or with 0 where any answer is right."""

    def answer(request: Mapping[str, Any]) -> Mapping[str, Any]:
        result = right_result(service, request)
        if isinstance(result, int):
            result = max(-(2**63), min(2**63 - 1, result))
        return {service.response: 0 if result is None else result}

    return answer
