"""The bench that checks are written against: everything a check can do to a learner's node or observe of it.

A check knows nothing of ROS, processes or the machine's timeouts; it asks the bench. The implementation on real DDS is
in `tutor.engine`. Tests of judges need no bench, since judges take plain facts.
"""

from __future__ import annotations

import math
from collections.abc import Awaitable, Callable, Mapping, Sequence
from contextlib import AbstractAsyncContextManager
from typing import Any, Protocol, TypeVar

from tutor.errors import MachineTooBusy as MachineTooBusy
from tutor.errors import NeedsInstalledRos as NeedsInstalledRos
from tutor.judge.interface_build import InterfaceBuild
from tutor.judge.peers import GoalClient, GoalReplies, GoalServer, Handler, HoldingServer, Offer, Publisher
from tutor.judge.trace import (
    CallAnswer,
    Echo,
    Ending,
    Exit,
    LogRecord,
    OutputLine,
    Sample,
    ServedRequest,
    SetAnswer,
    Trace,
)
from tutor.judge.tracebacks import Frame
from tutor.ros_model import Graph, Parameter

T = TypeVar("T")


class Run(Protocol):
    """One run of the learner's process, on a private domain, observed from before its first instruction."""

    @property
    def started_at(self) -> float:
        """When the process was started: seconds since the epoch."""

    @property
    def logs(self) -> Sequence[LogRecord]:
        """What the process has logged on `/rosout` so far."""

    @property
    def graph(self) -> Graph:
        """The learner's part of the graph as it is now."""

    @property
    def exit(self) -> Exit | None:
        """How the process ended, or None while it runs."""

    @property
    def output(self) -> Sequence[OutputLine]:
        """What the process has written to stdout and stderr so far, up to a size limit."""

    @property
    def served(self) -> Sequence[ServedRequest]:
        """The requests that our own service servers have answered so far."""

    def samples_on(self, topic: str) -> Sequence[Sample]:
        """The samples seen on a watched topic so far."""

    def watch(self, topic: str, type: str) -> bool:
        """Start collecting the samples of one more topic. Return False if this ROS installation lacks the type."""

    def serve(self, service: str, type: str, handler: Handler) -> None:
        """Start a service server of our own; the requests it answers are recorded in `served`."""

    def now(self) -> float:
        """The wall-clock time in seconds since the epoch, the clock of every fact."""

    def node_cpu_wait_s(self) -> float:
        """Seconds the process has spent waiting for a CPU so far (the machine's fault). 0.0 once it has ended."""

    def our_cpu_wait_s(self) -> float:
        """Seconds we, the observers, have spent waiting for a CPU so far: facts may reach us that much later."""

    async def until(self, seen: Callable[[], bool], limit_s: float, *, idle_s: float | None = None) -> bool:
        """Wait until `seen()` is true; it is called again whenever a new fact comes in.

        Return False after `limit_s` seconds (plus any in which the machine did not let the process run), or soon after
        the process has ended. With `idle_s`, also once the process has been idle for that long and will not wake by
        itself before the limit: all its threads are blocked, none with a timeout that expires within the limit. Where
        no datagram was lost, a second is enough, however long `idle_s`.
        """

    async def wait_for_exit(
        self,
        limit_s: float,
        *,
        meanwhile: Callable[[], object] = lambda: None,
        all_sent: Callable[[], bool] = lambda: False,
        given_up: Callable[[], bool] = lambda: False,
    ) -> bool:
        """Wait until the process has ended; `meanwhile` is called whenever a new fact comes in.

        Return False after `limit_s` seconds, plus any in which the machine kept the main thread waiting, and once
        `given_up()`. Once `all_sent()` is true, the process can expect nothing more from us: then also give up when it
        is idle (see `until`) for longer than a lost message takes to be resent.
        """

    async def parameters(self, limit_s: float) -> tuple[Parameter, ...] | None:
        """Ask every node for its parameters; None if no node answered within the limit.

        Like `set_parameters` and `call`, this also gives up when the process is idle (see `until`) for longer than a
        lost message takes to be resent.
        """

    async def set_parameters(
        self, node: str, values: Mapping[str, Any], *, atomic: bool = False, limit_s: float = 5.0
    ) -> SetAnswer:
        """Set parameters as `ros2 param set` does; with `atomic`, all in one atomic request."""

    async def call(
        self,
        service: str,
        type: str,
        request: Mapping[str, Any],
        *,
        limit_s: float,
        resend_s: float = math.inf,
        all_sent: Callable[[], bool] = lambda: True,
    ) -> CallAnswer:
        """Call a service as `ros2 service call` does: with a new client, once it is matched with the server.

        `resend_s`: send the request again whenever this many seconds pass without a response. A busy machine may lose
        one, so this is for requests without side effects. `all_sent`: whether the node has got all that it waits for;
        only then does it end the wait that the node is idle.
        """

    def publisher(self, topic: str, type: str) -> AbstractAsyncContextManager[Publisher]:
        """Create a publisher in a node and participant of our own; both leave the graph when the context exits.

        Messages published before a subscription is matched are lost (see `Publisher.subscribers`).
        """

    def offered(self, topic: str) -> Publisher:
        """Our publisher on this topic that was there before the process started (see `Offer`)."""

    def goal_client(self, action: str, type: str) -> AbstractAsyncContextManager[GoalClient]:
        """Create an action client in a node and participant of our own; both leave the graph when the context exits."""

    def goal_server(self, action: str, type: str, replies: GoalReplies) -> AbstractAsyncContextManager[GoalServer]:
        """Create an action server in a node and participant of our own; both leave the graph when the context exits."""

    def holding_server(self, service: str, type: str) -> AbstractAsyncContextManager[HoldingServer]:
        """Serve a service in a node and participant of our own; both leave the graph when the context exits."""

    async def echo(self, topic: str, *, samples: int, limit_s: float) -> Echo:
        """Subscribe as `ros2 topic echo` does: a separate participant that takes type and QoS from the publishers.

        It looks for up to `limit_s` seconds, longer while the machine lets neither the node nor us run.
        """

    async def interrupt(self, limit_s: float = 5.0) -> Ending | None:
        """Press Ctrl+C (SIGINT to the process group), wait for the process to end, and record what it leaves behind.

        Return None if the process had ended by itself, or was about to: something before Ctrl+C has ended it.
        """

    def command_lines(self) -> tuple[str, ...]:
        """The command lines of the learner's process and of all its living descendants."""

    def has_launched_all(self) -> bool:
        """Whether a launch has, at this moment, nothing more to start by itself.

        No timer is pending in it, and all its processes are nodes that are in the graph. Only what a node says or does
        may still make it start something.
        """

    async def dump_stacks(self) -> tuple[Frame, ...]:
        """Stop the process, if it is still running, and return the frames of all its threads, innermost first."""

    def trace(self) -> Trace:
        """An immutable snapshot of all facts so far."""


class Bench(Protocol):
    """Everything that one scenario of a check may use."""

    def start(
        self,
        file: str,
        *,
        parameters: Mapping[str, Any] | None = None,
        watch: Mapping[str, str] | None = None,
        log_level: str = "",
        offers: Sequence[Offer] = (),
        expected_s: float | None = None,
    ) -> AbstractAsyncContextManager[Run]:
        """Start one of the submission's files; every trace of the process is gone when the context exits.

        `parameters` are passed as `--ros-args -p name:=value`. `watch` maps topics to types; they are subscribed to
        before the process starts, and `offers` are publishers that are there by then. `log_level`: passed as
        `--ros-args --log-level`, as in "debug". `expected_s`: roughly how long this run, and everything that depends on
        it, takes with our own solution, in wall-clock seconds (default: the check's `expected_s`). It only decides
        which of many runs starts first.
        """

    def launch(self, file: str, *, arguments: Mapping[str, str] | None = None) -> AbstractAsyncContextManager[Run]:
        """Start one of the submission's files as `ros2 launch FILE name:=value ...` does.

        The run covers the whole launch: its process is the launch itself; its graph, logs and samples are those of all
        nodes. Packages resolve as in a built workspace. Every process is gone when the context exits.
        """

    def interface_builds(self) -> Sequence[InterfaceBuild]:
        """What became of the interface packages beside the submission's files, which were built before its start."""

    def has_file(self, file: str) -> bool:
        """Whether the submission has this (optional) file."""

    def read(self, file: str) -> str:
        """The text of one of the submission's files, such as data that the learner has written; "" without it."""

    async def facts(self, scenario: Scenario[T]) -> T:
        """The facts of another scenario of this check, which runs only once however many scenarios ask for it."""

    def report_progress(self, fraction: float, text: str) -> None:
        """Tell the learner how far this scenario is (0 to 1) and what is being done to their node."""

    def report_facts(self, facts: object) -> None:
        """Pass the facts so far to this scenario's early judges: they may already be enough to fail a criterion."""


Scenario = Callable[[Bench], Awaitable[T]]
"""Exercises the learner's node and returns the observed facts; also the key under which those facts are cached.

Facts may have an attribute `slowed`, and a scenario may raise MachineTooBusy: see `was_slowed`.
"""


def was_slowed(facts: object) -> bool:
    """Whether the machine may be to blame for what these facts show, so that they alone fail no criterion.

    These are the words for it, in facts and verdicts:

    - *slowed*: the node, or our process, waited for a CPU (`cpu_wait_s`) for so long that this may explain what was
      seen. A criterion that slowed facts fail is judged again on new ones.
    - *allowance*: the seconds that a limit is extended by for such a wait.
    - *undecided*: the verdict of a judge that cannot tell, from slowed facts, the node's fault from the machine's (see
      `tutor.judge.verdict.undecided`). The scenarios are repeated with nothing else running.
    - MachineTooBusy: what a scenario raises that was slowed too much to gather any facts, and is repeated likewise.
    """
    return bool(getattr(facts, "slowed", False))
