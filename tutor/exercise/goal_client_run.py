"""A run of the learner's action client against a server of ours, which comes up a little later."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf

from tutor.exercise.client_run import MIN_CPU_WAIT_AT_LIMIT_S, MIN_CPU_WAIT_S, ClientWatch
from tutor.exercise.nouns import GOAL_SERVICE, Action, Program
from tutor.exercise.service_calls import STUCK_CALL_S
from tutor.judge.bench import Bench, MachineTooBusy
from tutor.judge.peers import GoalReplies, GoalServer
from tutor.judge.stuck_nodes import StuckTest
from tutor.judge.trace import Exit, ServedGoal, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting_for_nodes import CPU_WAIT_SHARE, HARDLY_WAITED_SHARE, IDLE_S, wait_until_seen
from tutor.ros_model import ServiceEndpoint


@dataclass(frozen=True)
class GoalClientRun:
    """A run of an action client; `trace` is None if the submission has none.

    `replies`: what our server did with its goals. `stuck`: the stack, innermost frame first, of a client that did not
    exit within `watched_s`. `clients`: the actions whose clients it has, by name and type. `slowed`: see
    `tutor.judge.bench.was_slowed`.
    """

    trace: Trace | None
    replies: GoalReplies = field(default_factory=GoalReplies)
    goals: tuple[ServedGoal, ...] = ()
    exit: Exit | None = None
    stuck: tuple[Frame, ...] = ()
    clients: tuple[ServiceEndpoint, ...] = ()
    watched_s: float = inf
    slowed: bool = False


@dataclass(frozen=True)
class DumpSilentGoalClient:
    """Start the client once more, with our server up, only to see where it is when it goes on no longer."""

    client: Program
    action: Action
    replies: Callable[[], GoalReplies] = field(hash=False)

    async def __call__(self, bench: Bench) -> tuple[Frame, ...]:
        action, replies = self.action, self.replies()
        async with (
            bench.start(self.client.file) as run,
            run.goal_server(action.name, action.type, replies) as server,
        ):
            bench.report_progress(0.9, "looking where the client is stuck")
            server.open()
            await wait_until_seen(run, lambda: bool(server.goals))
            await run.until(lambda: run.exit is not None or _all_told(server), _takes_s(replies))
            await run.until(lambda: run.exit is not None, STUCK_CALL_S)
            return await run.dump_stacks() if run.exit is None else ()


@dataclass(frozen=True)
class RunGoalClient:
    """Run the client, and bring up our action server a little later. `within_s`: how long it may take, in seconds."""

    client: Program
    action: Action
    replies: Callable[[], GoalReplies] = field(hash=False)
    within_s: float

    async def __call__(self, bench: Bench) -> GoalClientRun:
        if not bench.has_file(self.client.file):
            return GoalClientRun(None)
        action, replies = self.action, self.replies()
        silent = DumpSilentGoalClient(self.client, action, self.replies)
        async with (
            bench.start(self.client.file, expected_s=3.0) as run,
            run.goal_server(action.name, action.type, replies) as server,
            StuckTest(run, lambda: bench.facts(silent)) as test,
        ):
            bench.report_progress(0.2, "running the client, before there is a server")
            answered = lambda: sum(1 + goal.feedback + goal.ended for goal in server.goals)  # noqa: E731
            watch = ClientWatch(bench, run, test, server.open, answered)
            waited_s, our_wait_s = 0.0, run.our_cpu_wait_s()

            def look() -> None:
                nonlocal waited_s
                watch.look()
                if run.exit is None:  # nothing is known of it later
                    waited_s = run.node_cpu_wait_s()

            await run.wait_for_exit(
                self.within_s,
                meanwhile=look,
                all_sent=lambda: watch.up_at is not None and _all_told(server),
                given_up=lambda: test.is_stuck() and _all_told(server),
            )
            watched_s = run.now() - run.started_at
            if run.exit is not None:
                await run.until(lambda: False, IDLE_S)  # its last messages may still be on their way
            trace, goals, ended = run.trace(), tuple(server.goals), run.exit
            stuck = await run.dump_stacks() if ended is None else ()
            clients = tuple(client for client in watch.clients if client.name.endswith(GOAL_SERVICE))
            waited_s += run.our_cpu_wait_s() - our_wait_s
            left_after_us = ended is not None and watch.up_at is not None  # else it did not wait for a server at all
            if not goals and left_after_us and waited_s >= CPU_WAIT_SHARE * watched_s:
                raise MachineTooBusy("this machine is too busy for a client to find our action server in time")
            slowed = waited_s >= HARDLY_WAITED_SHARE * watched_s or (not goals and _missed_server(watch, ended))
            return GoalClientRun(trace, replies, goals, ended, stuck, clients, watched_s, slowed)


def _all_told(server: GoalServer) -> bool:
    return all(goal.ended or not goal.accepted for goal in server.goals)


def _takes_s(replies: GoalReplies) -> float:
    """How long our server takes for a goal, at most."""
    return (len(replies.feedback) + 1) * replies.step_s + 2.0


def _missed_server(watch: ClientWatch, ended: Exit | None) -> bool:
    """Whether the machine may be to blame for a client that did not find our server."""
    return watch.cpu_wait_s >= (MIN_CPU_WAIT_S if ended is not None else MIN_CPU_WAIT_AT_LIMIT_S)
