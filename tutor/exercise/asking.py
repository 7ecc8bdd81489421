"""A service that the node answers by asking another one, which we serve: what it is, and how scenarios call it."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any, Literal

from tutor.exercise.nouns import Program, Service, agrees
from tutor.exercise.seen_run import MATCH_S, Seen
from tutor.exercise.service_calls import ANSWER_S, STUCK_CALL_S, Server
from tutor.judge.bench import Bench, Run
from tutor.judge.peers import HoldingServer
from tutor.judge.tasks import Tasks
from tutor.judge.trace import CallAnswer, HeldRequest
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting_for_nodes import HARDLY_WAITED_SHARE

REACH_S = 5.0
"""Time in which the node finds our server: until then, it may rightly answer that there is none."""

GIVEN_UP_S = 0.5
"""A refusal that takes this long, though we have replied at once, comes at the end of a time limit."""

LATE_S = 1.0
"""A node that gives up has waited for longer than this."""

AGAIN_S = 0.3
"""Pause between two calls of a node that may not have found our server yet."""

Values = tuple[Any, ...]
"""The values of a request's fields, in their order."""


@dataclass(frozen=True)
class Asking:
    """A service that the node answers by asking another one, which the check serves.

    `service`: the node's, and `asks`: the other one, each with the fields of its `request`. `requests`: the values of
    those fields in two different calls, which the node passes on as they are, or as `asks_with` makes them. `replies`:
    returns the fields of our reply, given the values that we are asked with; draw them at random, so that no answer can
    be written down. `becomes`: the fields of the right answer, given our reply; the reply itself, if not given. A text
    is right as a part of the field. `refusal`: the fields of the answer where no reply comes: each its value, or a
    function that says whether a value is right; then `refused` says in words what that is.

        COOKING = Asking(
            Service("/cook", "std_srvs/srv/SetBool", ("data",)),
            Service("/oven", "std_srvs/srv/SetBool", ("data",)),
            requests=((True,), (False,)),
            replies=lambda hot: {"success": True, "message": f"oven {random.randint(100, 999)}"},
            refusal={"success": False, "message": bool},
            refused="success=False and a message",
        )
    """

    service: Service
    asks: Service
    requests: tuple[Values, ...]
    replies: Callable[..., Mapping[str, Any]]
    asks_with: Callable[..., Values] | None = None
    becomes: Callable[[Mapping[str, Any]], Mapping[str, Any]] | None = None
    refusal: Mapping[str, Any] = field(default_factory=dict, hash=False)
    refused: str = ""

    def __post_init__(self) -> None:
        if len(set(self.requests)) < 2:
            raise ValueError(f"{self.service.name}: give two different `requests`, so that answers can be told apart")

    def request(self, given: Values) -> dict[str, Any]:
        """The fields of a request to the node."""
        return dict(zip(self.service.request, given, strict=True))

    def passed_on(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """The fields that our server must be asked with for this request to the node."""
        given = tuple(request[name] for name in self.service.request)
        return dict(zip(self.asks.request, self.asks_with(*given) if self.asks_with else given, strict=True))

    def right_answer(self, reply: Mapping[str, Any]) -> Mapping[str, Any]:
        """The fields of the answer, given our reply."""
        return self.becomes(reply) if self.becomes else reply


@dataclass(frozen=True)
class Exchange:
    """What our server was asked, and when. `reply`: what it replied, None if nothing."""

    asked: Mapping[str, Any]
    at: float
    reply: Mapping[str, Any] | None


@dataclass(frozen=True)
class AskingCall:
    """A call of the node's service, and what our server was asked meanwhile.

    `held_s`: for how long our reply was held back, in seconds, unless the node answered without it.
    """

    answer: CallAnswer
    exchanges: tuple[Exchange, ...] = ()
    held_s: float = 0.0

    @property
    def ended_early(self) -> bool:
        """Whether it was answered so early that, if that is a refusal, no reply that takes so long is waited for."""
        return bool(self.held_s) and self.answer.took_s < self.held_s + GIVEN_UP_S

    @property
    def replies(self) -> tuple[Mapping[str, Any], ...]:
        """What our server replied meanwhile."""
        return tuple(exchange.reply for exchange in self.exchanges if exchange.reply is not None)


@dataclass(frozen=True)
class AskingRun(Seen):
    """A run in which the node was called. `offered`: whether its service was there. `calls`: in their order."""

    offered: bool = True
    calls: tuple[AskingCall, ...] = ()


class Desk:
    """Our server, with what it is asked and what it replies."""

    def __init__(self, run: Run, asking: Asking, server: HoldingServer) -> None:
        self._run, self._asking, self._server = run, asking, server
        self._replies: dict[int, Mapping[str, Any]] = {}
        self.replies_at_once = True

    @property
    def requests(self) -> tuple[HeldRequest, ...]:
        """All that the node has asked so far."""
        return tuple(self._server.requests)

    @property
    def held(self) -> list[HeldRequest]:
        """The requests without a reply."""
        return [request for request in self.requests if request.number not in self._replies]

    def reply(self, *requests: HeldRequest) -> None:
        """Reply to these requests, in their order."""
        for request in requests:
            given = (request.request[name] for name in self._asking.asks.request)
            self._replies[request.number] = self._asking.replies(*given)
            self._server.reply(request, self._replies[request.number])

    async def attend(self) -> None:
        """Reply to each request as it comes, while `replies_at_once`."""
        while self._run.exit is None:
            await self._run.until(lambda: self.replies_at_once and bool(self.held), inf)
            self.reply(*self.held)

    async def call(self, given: Values, limit_s: float = ANSWER_S) -> AskingCall:
        """Call the node's service."""
        service, began = self._asking.service, self._run.now()
        answer = await self._run.call(service.name, service.type, self._asking.request(given), limit_s=limit_s)
        return self.with_exchanges(answer, began)

    async def call_and_hold(self, given: Values, hold_s: float) -> AskingCall:
        """Call the node's service, and reply once its request has been there for `hold_s`, or the node has answered.

        Requests from before get their replies as soon as it is there: too late, if the node has given them up.
        """
        before, began = len(self.requests), self._run.now()
        async with Tasks() as tasks:
            calling = tasks.start(self.call_unreplied(given, hold_s + ANSWER_S))
            await self._run.until(lambda: len(self.requests) > before or calling.done(), ANSWER_S)
            self.reply(*(request for request in self.held if request.at < began))
            until = self._run.now() + hold_s
            await self._run.until(lambda: calling.done() or self._run.now() >= until, hold_s)
            self.reply(*self.held)
            self.replies_at_once = True
            return replace(self.with_exchanges(await calling, began), held_s=hold_s)

    async def call_unreplied(self, given: Values, limit_s: float) -> CallAnswer:
        """Call the node's service, and let requests wait until `replies_at_once` is set again.

        While one waits, the node has a reason to do nothing, so that its being idle does not end the call.
        """
        service, self.replies_at_once = self._asking.service, False
        request = self._asking.request(given)
        return await self._run.call(
            service.name, service.type, request, limit_s=limit_s, all_sent=lambda: self.replies_at_once or not self.held
        )

    def with_exchanges(self, answer: CallAnswer, since: float) -> AskingCall:
        """A call with what was asked from then on, as far as it is known now."""
        asked = [request for request in self.requests if request.at >= since]
        exchanges = (Exchange(request.request, request.at, self._replies.get(request.number)) for request in asked)
        return AskingCall(answer, tuple(exchanges))

    async def reach(self, limit_s: float = ANSWER_S) -> AskingCall:
        """Call the node until it asks us, or answers otherwise than if we were not there; return the last call."""
        until = self._run.now() + REACH_S
        call = await self.call(self._asking.requests[0], limit_s)
        while not call.exchanges and answers_with(call.answer, self._asking.refusal) and self._run.now() < until:
            again_at = self._run.now() + AGAIN_S
            await self._run.until(lambda: self._run.now() >= again_at, 2 * AGAIN_S)  # noqa: B023
            call = await self.call(self._asking.requests[0], limit_s)
        return call


@asynccontextmanager
async def open_desk(run: Run, asking: Asking) -> AsyncIterator[Desk]:
    """Bring up our server, which replies at once until it is told otherwise."""
    async with run.holding_server(asking.asks.name, asking.asks.type) as server, Tasks() as tasks:
        desk = Desk(run, asking, server)
        attending = tasks.start(desk.attend())
        yield desk
        if attending.done():
            attending.result()  # raises what `replies` of the exercise has raised


async def wait_for_both(run: Run, program: Program, asking: Asking) -> bool:
    """Wait for the node's service, and, if our server is up, until the node can know it. Return whether it is there."""
    server = Server(program, (asking.service,))
    await server.wait(run)
    there = not server.missing(run.graph.servers)
    if there:
        until = run.now() + MATCH_S
        await run.until(lambda: run.now() >= until, MATCH_S)
    return there


class BusyWatch:
    """Tells whether the machine may be to blame for an answer that is missing, or was given up, since this was made."""

    def __init__(self, run: Run) -> None:
        self._run, self._since, self._waited_s = run, run.now(), _cpu_wait_s(run)

    def is_to_blame(self, *calls: AskingCall) -> bool:
        """Whether, after our reply, one of these calls got no answer, or a late one, while the node or we were slowed.

        A reply may get lost, or a node give up, before it is there. Without a reply, the limit of the call is enough.
        """
        late = any(call.replies and (call.answer.response is None or call.answer.took_s >= LATE_S) for call in calls)
        return late and _cpu_wait_s(self._run) - self._waited_s >= HARDLY_WAITED_SHARE * (self._run.now() - self._since)


def _cpu_wait_s(run: Run) -> float:
    """How long the node and our own process, which replies to it, have waited for a CPU, in seconds."""
    return run.node_cpu_wait_s() + run.our_cpu_wait_s()


@dataclass(frozen=True)
class DumpWhileAsking:
    """Start without parameters, call the node, and return its stack while it does not answer.

    `ours`: whether our server replies, holds the request, or is not there.
    """

    program: Program
    asking: Asking
    ours: Literal["replies", "holds", "missing"]

    async def __call__(self, bench: Bench) -> tuple[Frame, ...]:
        async with bench.start(self.program.file) as run:
            bench.report_progress(0.9, "looking where the node is while it should answer")
            if self.ours == "missing":
                return await self._dump(run)
            async with open_desk(run, self.asking) as desk:
                desk.replies_at_once = self.ours == "replies"
                return await self._dump(run)

    async def _dump(self, run: Run) -> tuple[Frame, ...]:
        service, given = self.asking.service, self.asking.requests[0]
        await wait_for_both(run, self.program, self.asking)
        await run.call(service.name, service.type, self.asking.request(given), limit_s=STUCK_CALL_S)
        return await run.dump_stacks() if run.exit is None else ()


def is_right(asking: Asking, call: AskingCall) -> bool:
    """Whether a call got the answer that follows from a reply to its own request."""
    own = asking.passed_on(call.answer.request)
    replies = [exchange.reply for exchange in call.exchanges if agrees(exchange.asked, own)]
    return any(reply is not None and answers_with(call.answer, asking.right_answer(reply)) for reply in replies)


def gave_up(asking: Asking, call: AskingCall) -> bool:
    """Whether a call was refused at the end of some time limit, though our server has replied."""
    refused = bool(asking.refusal) and answers_with(call.answer, asking.refusal)
    return refused and bool(call.replies) and call.answer.took_s >= GIVEN_UP_S


def answers_with(answer: CallAnswer, wanted: Mapping[str, Any]) -> bool:
    """Whether a response has these fields: a text as a part of its field, others as they are."""
    response = answer.response
    return response is not None and all(_has(response[name], value) for name, value in wanted.items())


def _has(value: Any, wanted: Any) -> bool:
    if callable(wanted):
        is_right: Callable[[Any], object] = wanted
        return bool(is_right(value))
    return wanted in value if isinstance(wanted, str) and isinstance(value, str) else agrees(value, wanted)
