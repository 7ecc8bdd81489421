"""I1.2: the scenario of all trials: the node is started, and sent the messages of a plan."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import AsyncExitStack
from dataclasses import KW_ONLY, dataclass, replace
from itertools import accumulate

from checks.i1_2_message_statistics import plans
from checks.i1_2_message_statistics.logged_summaries import find_summaries, last_due_count
from checks.i1_2_message_statistics.trial import CHATTER, PROGRAM, SOON_S, Sent, Trial
from tutor.judge.bench import Bench, Run
from tutor.judge.ending import repeat_chance_failures
from tutor.judge.peers import Publisher
from tutor.judge.stuck_nodes import ask_unless_stuck
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting_for_nodes import patience_s, wait_until_log_quiet, wait_until_seen

QUIET_S = 0.8
"""How long a node is up before the first message, so that a rate counted from its start is clearly too low."""

MATCH_S = 0.4
"""Once we have discovered a best-effort subscription, it has discovered our publisher within this time."""

SPIN_S = 2.0
"""Time limit for a subscribed, spinning node to answer a request; twice as long if it sleeps first."""

ABSENT_S = 0.7
"""How long there is no publisher: nobody restarts a talker faster."""

STUCK_HZ = 50.0
"""The rate of messages to a node that waits for ever: it makes no difference to it."""

STUCK_S = 1.5
"""Time within which a node that got a message has reached the call that blocks it."""

LINE_GAP_S = 0.15
"""Maximum gap between two log messages of one summary."""

LOG_QUIET_LIMIT_S = 1.0
"""Maximum wait for a quiet log, since some nodes log all the time."""


@dataclass(frozen=True)
class Feed:
    """Start the node and send it messages; gather what it logs, up to the last summary.

    `settled_s`: how long the subscription has been there when the first message comes. `ctrl_c`: press Ctrl+C at the
    end. `explains_silence`: do so if there is no summary, since the last output may show why, and look where a node is
    stuck that does not answer.
    """

    plan: plans.Plan
    _: KW_ONLY
    settled_s: float = MATCH_S
    ctrl_c: bool = False
    explains_silence: bool = False

    async def __call__(self, bench: Bench) -> Trial:
        return await (repeat_chance_failures(self._run) if self.ctrl_c else self._run)(bench)

    async def _run(self, bench: Bench) -> Trial:
        stretches = await self.plan(bench)
        async with bench.start(PROGRAM.file, expected_s=self._expected_s(stretches)) as run, Talker(bench, run) as ours:
            await ours.wait_for_match(self.settled_s)
            trial = Trial(run.trace(), spins=ours.spins)
            if ours.publisher.subscribers:
                waited_before_s = run.node_cpu_wait_s()
                for stretch in stretches:
                    if stretch.another_publisher and not await ours.take_over():
                        break
                    await ours.send(stretch.numbers, STUCK_HZ if ours.is_stuck else stretch.hz)
                trial = Trial(
                    run.trace(),
                    tuple(ours.sent),
                    tuple(accumulate(len(stretch.numbers) for stretch in stretches[:-1])),
                    ours.left_at,
                    run.node_cpu_wait_s() - waited_before_s,
                    ours.spins,
                    new_subscriptions=ours.new_subscriptions,
                )
                trial = trial if ours.is_stuck else await collect_last_logs(run, trial)
            silent = self.explains_silence and bool(trial.sent) and not find_summaries(trial)
            if self.ctrl_c or silent:
                bench.report_progress(0.95, "pressing Ctrl+C")
                trial = replace(trial, ending=await run.interrupt())
        if silent and not trial.spins and trial.trace.exit is None:
            return replace(trial, stuck=await bench.facts(dump_stuck_node))
        return trial

    def _expected_s(self, stretches: Iterable[plans.Stretch]) -> float:
        away_s = SOON_S + ABSENT_S + MATCH_S
        return self.settled_s + sum(len(s.numbers) / s.hz + away_s * s.another_publisher for s in stretches)


async def dump_stuck_node(bench: Bench) -> tuple[Frame, ...]:
    """Start the node once more, only to dump its stacks while it does not respond."""
    async with bench.start(PROGRAM.file) as run, Talker(bench, run) as ours:
        bench.report_progress(0.9, "looking where the node is stuck")
        await wait_until_seen(run, lambda: ours.publisher.subscribers > 0)
        ours.publisher.publish({"data": "Hello World: 0"})
        await pause(run, STUCK_S)
        return await run.dump_stacks()


class Talker:
    """Our talker in one run, and what is known of the node that listens to it.

    `sent`: its messages so far. `left_at`: when its first publisher left, 0.0 if it has not. `new_subscriptions`: how
    many more the node has made while messages were sent. `spins`: whether the node has answered a request. `is_stuck`:
    whether another start shows that it waits for ever.
    """

    def __init__(self, bench: Bench, run: Run) -> None:
        self._bench, self._run = bench, run
        self._leaving = AsyncExitStack()
        self.publisher: Publisher
        self.sent: list[Sent] = []
        self.left_at = 0.0
        self.new_subscriptions = 0
        self.spins, self.is_stuck = True, False

    async def __aenter__(self) -> Talker:
        await self._appear()
        return self

    async def _appear(self) -> None:
        self.publisher = await self._leaving.enter_async_context(self._run.publisher(CHATTER.name, CHATTER.type))

    async def __aexit__(self, *_: object) -> None:
        await self._leaving.aclose()

    async def wait_for_match(self, settled_s: float) -> None:
        """Wait until our publisher and the subscription are matched, and see whether the node answers a request."""
        run = self._run

        def subscriptions() -> list[tuple[str, str]]:
            return [(subscription.topic, subscription.type) for subscription in run.graph.subscriptions]

        self._bench.report_progress(0.05, "waiting for the subscription")
        await wait_until_seen(
            run,
            lambda: self.publisher.subscribers > 0,
            promised=lambda: (CHATTER.name, CHATTER.type) in subscriptions(),
            message_gap_s=1.0,
            settle_s=lambda: patience_s(subscriptions(), CHATTER.name, CHATTER.type),
        )
        matched_at = run.now()
        if run.exit is not None:
            return
        if await run.until(lambda: bool(run.graph.parameter_nodes), 1.0):
            answer, self.is_stuck = await ask_unless_stuck(run, SPIN_S, lambda: self._bench.facts(dump_stuck_node))
            self.spins = answer is not None
        if not self.is_stuck:
            await pause(run, matched_at + settled_s - run.now())

    async def send(self, numbers: Iterable[int], hz: float) -> None:
        """Send a message for each number at a steady rate; stop if the node has ended."""
        run, sent, matches = self._run, self.sent, self.publisher.matches
        due = max(sent[-1].at + 1 / hz, run.now()) if sent else run.now()
        for number in numbers:
            # Catch up after a delay, but never send two at once, which would be no steady rate.
            earliest = sent[-1].at + 0.5 / hz if sent else due
            await pause(run, max(due, earliest) - run.now())
            due += 1 / hz
            if run.exit is not None:
                break
            sample = self.publisher.publish({"data": f"Hello World: {number}"})
            sent.append(Sent(number, sample.source_time, run.node_cpu_wait_s()))
            self._bench.report_progress(0.1 + 0.04 * min(len(sent), 20), f"sending “Hello World: {number}”")
        self.new_subscriptions += self.publisher.matches - matches

    async def take_over(self) -> bool:
        """Let another publisher take the place of ours; return whether the node subscribes to it."""
        run = self._run
        await pause(run, SOON_S / 2)
        self.left_at = run.now()  # taken before it leaves, since the node may log that immediately
        await self._leaving.aclose()
        await pause(run, ABSENT_S)
        await self._appear()
        await run.until(lambda: self.publisher.subscribers > 0, SPIN_S)
        if not self.publisher.subscribers:
            return False
        await pause(run, MATCH_S)
        return True


async def pause(run: Run, for_s: float) -> None:
    """Wait as a talker does between two messages."""
    until = run.now() + for_s
    if for_s > 0:
        await run.until(lambda: run.now() >= until, for_s)


async def collect_last_logs(run: Run, trial: Trial) -> Trial:
    """Wait for the last summary, and then until the log is quiet, each within a limit."""

    def current() -> Trial:
        return replace(trial, trace=run.trace())

    def limit_s(since: float) -> float:
        return max(since + trial.summary_limit_s - run.now(), 0.0)

    if last := last_due_count(len(trial.sent)):
        # From the last message on: a node that restarts its count for a new publisher logs its summary later.
        since = trial.sent[-1].at
        await run.until(lambda: any(summary.messages >= last for summary in find_summaries(current())), limit_s(since))
    if trial.jumps:
        jumped_at = trial.sent[trial.jumps[-1]].at
        await run.until(lambda: logs_something_new(jumped_at, current()), limit_s(jumped_at))
    await wait_until_log_quiet(run, quiet_s=LINE_GAP_S, max_s=LOG_QUIET_LIMIT_S)
    return current()


def logs_something_new(jumped_at: float, trial: Trial) -> bool:
    """Whether a line was logged since `jumped_at` of a kind that is no summary's, nor logged before the first jump."""
    usual_kinds = {line.kind for line in trial.lines if line.messages <= trial.before_break}
    usual_kinds |= {line.kind for summary in find_summaries(trial) for line in summary.lines}
    return any(line.at >= jumped_at and line.kind not in usual_kinds for line in trial.lines)
