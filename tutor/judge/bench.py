"""The bench that checks are written against: what can be done to a learner's node, and what can be seen of it.

A check knows nothing of ROS, processes or time-outs of the machine; it asks the bench. The one on real DDS is in
`tutor.engine`; tests of pure judging need none, since judges take plain facts.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from contextlib import AbstractAsyncContextManager
from typing import Any, Protocol, TypeVar

from tutor.errors import MachineTooBusy as MachineTooBusy
from tutor.errors import NeedsInstalledRos as NeedsInstalledRos
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
from tutor.ros_model import Graph, Parameter, TopicEndpoint

T = TypeVar("T")


Handler = Callable[[Mapping[str, Any]], Mapping[str, Any]]
"""Answers one service request (fields to values) with a response (fields to values)."""


class Publisher(Protocol):
    """Our publisher on the learner's domain, with a talker's QoS: reliable, volatile, a queue of 10."""

    @property
    def endpoint(self) -> TopicEndpoint:
        """What the learner's node sees of it."""

    @property
    def subscribers(self) -> int:
        """How many subscriptions are matched with it now."""

    def publish(self, message: Mapping[str, Any]) -> Sample:
        """Publish a message (fields to values) at once; gives it with the time at which it was sent."""


class Run(Protocol):
    """One start of the learner's process, on a domain of its own, watched from before its first instruction."""

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
        """What the process has written to stdout and stderr so far (bounded)."""

    @property
    def served(self) -> Sequence[ServedRequest]:
        """The requests that our own servers have answered so far."""

    def samples_on(self, topic: str) -> Sequence[Sample]:
        """The samples seen on a watched topic so far."""

    def watch(self, topic: str, type: str) -> bool:
        """Collect the samples of one more topic from now on. Gives False where this ROS has no such type."""

    def serve(self, service: str, type: str, handler: Handler) -> None:
        """Offer a service of our own from now on; what it answers is in `served`."""

    def now(self) -> float:
        """The wall-clock time, in seconds since the epoch, as in every fact."""

    def node_cpu_wait_s(self) -> float:
        """Seconds that the process waited for a CPU so far: the machine's fault. 0.0 once it has ended."""

    def our_cpu_wait_s(self) -> float:
        """Seconds that we, the observers, waited for a CPU so far: what is seen may be seen that much later."""

    async def until(self, seen: Callable[[], bool], limit_s: float, *, idle_s: float | None = None) -> bool:
        """Wait until `seen()` is true; it is asked again whenever a new fact has come in.

        Gives False when `limit_s` seconds have passed (and those in which the machine did not let the process run), or
        soon after the process has ended. With `idle_s`, also once the process has done nothing for that long, and
        will do nothing by itself before the limit: all its threads wait, none of them for a time within it.
        """

    async def wait_for_exit(
        self,
        limit_s: float,
        *,
        meanwhile: Callable[[], object] = lambda: None,
        all_sent: Callable[[], bool] = lambda: False,
    ) -> bool:
        """Wait until the process has ended; `meanwhile` is called whenever a new fact has come in.

        Gives False when `limit_s` seconds have passed, and those in which the machine kept its main thread waiting.
        Once `all_sent()`, there is nothing more from us that it could wait for: then also when it is idle (see
        `until`) for longer than it takes to send a lost message again.
        """

    async def parameters(self, limit_s: float) -> tuple[Parameter, ...] | None:
        """Ask every node for its parameters; None where no node answered within the limit.

        This and the next two give up, too, when the process is idle (see `until`) for longer than it takes to send a
        lost message again.
        """

    async def set_parameters(
        self, node: str, values: Mapping[str, Any], *, atomic: bool = False, limit_s: float = 5.0
    ) -> SetAnswer:
        """Set parameters as `ros2 param set` does (or, `atomic`, all in one atomic request)."""

    async def call(self, service: str, type: str, request: Mapping[str, Any], *, limit_s: float) -> CallAnswer:
        """Call a service as `ros2 service call` does: a client of its own, once it is matched."""

    def publisher(self, topic: str, type: str) -> AbstractAsyncContextManager[Publisher]:
        """Publish on a topic, from a node and participant of our own; both are out of the graph when the context ends.

        Messages sent before a subscription is matched are lost (see `Publisher.subscribers`).
        """

    async def echo(self, topic: str, *, samples: int, limit_s: float) -> Echo:
        """Subscribe as `ros2 topic echo` does: an independent participant, type and QoS taken from the publishers."""

    async def interrupt(self, limit_s: float = 5.0) -> Ending:
        """Press Ctrl+C (SIGINT to the process group), watch the process end, and see what it leaves behind."""

    async def command_lines(self) -> tuple[str, ...]:
        """The command lines of all living processes that the learner's process has started, itself included."""

    async def dump_stacks(self) -> tuple[Frame, ...]:
        """Where the process was, if it had not ended: ends it, and gives all threads' frames, innermost first."""

    def trace(self) -> Trace:
        """All facts so far, frozen."""


class Bench(Protocol):
    """What one scenario of a check may do."""

    def start(
        self,
        file: str,
        *,
        parameters: Mapping[str, Any] | None = None,
        watch: Mapping[str, str] | None = None,
        expected_s: float | None = None,
    ) -> AbstractAsyncContextManager[Run]:
        """Start one of the submission's files; nothing of it is left when the context ends.

        `parameters` are given as `--ros-args -p name:=value`; `watch` maps topics to types and is subscribed before the
        process starts.
        `expected_s`: about how many seconds of the clock this start, and what waits for it, ask for when it is our own
        solution; without it, the check's `expected_s`. It only decides which start goes first where there are many.
        """

    def launch(self, file: str, *, arguments: Mapping[str, str] | None = None) -> AbstractAsyncContextManager[Run]:
        """Start one of the submission's files as `ros2 launch FILE name:=value ...` does.

        The run is that of the whole launch: its process is the launch itself, its graph, logs and samples those of all
        nodes. Packages resolve as they do in a workspace that is built. Nothing of it is left when the context ends.
        """

    def has_file(self, file: str) -> bool:
        """Whether the submission has this (optional) file."""

    async def facts(self, scenario: Scenario[T]) -> T:
        """The facts of another scenario of this check; it is run once, however many ask."""

    def report_progress(self, fraction: float, text: str) -> None:
        """Tell the learner how far this scenario is (0 to 1) and what is being done to their node."""

    def report_facts(self, facts: object) -> None:
        """Give what is known by now, for the early judges of this scenario: a criterion may be sure to fail by it."""


Scenario = Callable[[Bench], Awaitable[T]]
"""Does something to the learner's node and gives the facts seen; the key under which the facts are kept.

Facts may have an attribute `slowed` (see `was_slowed`). A scenario in which the machine was too busy for any facts
raises MachineTooBusy, and is repeated alone.
"""


def was_slowed(facts: object) -> bool:
    """Whether facts say that the machine slowed the node down: a criterion that fails by them is judged by new ones."""
    return bool(getattr(facts, "slowed", False))
