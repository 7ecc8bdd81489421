"""I1.2: the scenarios that exercise the node."""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from checks.i1_2.facts import (
    ABSENT_S,
    AFTER_ZERO_MESSAGES,
    FAST_HZ,
    FAST_MESSAGES,
    FILE,
    FIRST_NUMBERS,
    JUMP_AFTER,
    JUMP_MESSAGES,
    LEFT_OUT,
    MATCH_S,
    QUIET_S,
    RESTART_AFTER,
    RESTART_MESSAGES,
    RESTARTED_HZ,
    SECOND_JUMP_AFTER,
    SOON_S,
    STEADY_HZ,
    STEADY_MESSAGES,
    TOPIC,
    TYPE,
    UNTIMED_HZ,
    Sent,
    Trial,
)
from checks.i1_2.summaries import find_summaries, last_due_count
from tutor.judge.bench import Bench, Publisher, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.stuck import ask_unless_stuck
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import patience_s, wait_until_log_quiet, wait_until_seen

SPIN_S = 2.0
"""Time limit for a subscribed, spinning node to answer a request; twice as long if it sleeps first."""

STUCK_HZ = 50.0
"""The rate of messages to a node that waits for ever."""

LINE_GAP_S = 0.15
"""Maximum gap between two log messages of one summary."""

LOG_QUIET_LIMIT_S = 1.0
"""Maximum wait for a quiet log, since some nodes log all the time."""

STUCK_S = 1.5
"""Time within which a node that got a message has reached the call that blocks it."""

STEADY_EXPECTED_S = QUIET_S + STEADY_MESSAGES / STEADY_HZ[0]
JUMP_EXPECTED_S = MATCH_S + JUMP_MESSAGES / UNTIMED_HZ
AFTER_ZERO_EXPECTED_S = MATCH_S + AFTER_ZERO_MESSAGES / UNTIMED_HZ
FAST_EXPECTED_S = MATCH_S + FAST_MESSAGES / FAST_HZ


async def steady(bench: Bench) -> Trial:
    """Send messages at a steady rate, with N counting up from 0.

    A node without a summary is ended with Ctrl+C, since its last output may show why.
    """
    async with bench.start(FILE, expected_s=STEADY_EXPECTED_S) as run, run.publisher(TOPIC, TYPE) as talker:
        bench.report_progress(0.05, "waiting for the subscription")
        match = await _wait_for_match(bench, run, talker, QUIET_S)
        if not talker.subscribers:
            return Trial(run.trace(), spins=match.spins)
        trial = await _send_all(bench, run, talker, match, range(STEADY_MESSAGES), random.uniform(*STEADY_HZ))
        trial = await _collect_last_logs(run, trial, match)
        if find_summaries(trial):
            return trial
        trial = replace(trial, ending=await run.interrupt())
    if trial.sent and not trial.spins and trial.trace.exit is None:
        return replace(trial, stuck=await bench.facts(_dump_stuck_node))
    return trial


async def choose_numbers(bench: Bench) -> tuple[int, int]:
    """Choose the first N, and how many numbers to skip, for both starts with jumps, so that they can be compared."""
    return random.randint(*FIRST_NUMBERS), random.randint(*LEFT_OUT)


async def jump(bench: Bench) -> Trial:
    """Send messages from a random N on, and skip several numbers."""
    return await _jump(bench, (JUMP_AFTER,))


async def jump_twice(bench: Bench) -> Trial:
    """Do the same, and ten messages later, skip one more number."""
    return await _jump(bench, (JUMP_AFTER, SECOND_JUMP_AFTER))


async def _jump(bench: Bench, jumps: Sequence[int]) -> Trial:
    number, left_out = await bench.facts(choose_numbers)
    async with bench.start(FILE, expected_s=JUMP_EXPECTED_S) as run, run.publisher(TOPIC, TYPE) as talker:
        match = await _wait_for_match(bench, run, talker, MATCH_S)
        if not talker.subscribers:
            return Trial(run.trace(), spins=match.spins)
        waited_before_s = run.node_cpu_wait_s()
        sent: list[Sent] = []
        for begin, end in pairwise((0, *jumps, JUMP_MESSAGES)):
            if begin:
                number += left_out if begin == JUMP_AFTER else 1
            await _send(bench, run, talker, sent, range(number, number + end - begin), match.hz(UNTIMED_HZ))
            number += end - begin
        before_break, before_second_jump = (
            after if after in jumps and len(sent) > after else 0 for after in (JUMP_AFTER, SECOND_JUMP_AFTER)
        )
        cpu_wait_s = run.node_cpu_wait_s() - waited_before_s
        trial = Trial(
            run.trace(),
            tuple(sent),
            before_break,
            cpu_wait_s=cpu_wait_s,
            spins=match.spins,
            before_second_jump=before_second_jump,
        )
        return await _collect_last_logs(run, trial, match)


async def jump_after_zero(bench: Bench) -> Trial:
    """Send 0 as the first message, and skip several numbers right after it."""
    _, left_out = await bench.facts(choose_numbers)
    numbers = (0, *range(left_out + 1, left_out + AFTER_ZERO_MESSAGES))
    async with bench.start(FILE, expected_s=AFTER_ZERO_EXPECTED_S) as run, run.publisher(TOPIC, TYPE) as talker:
        match = await _wait_for_match(bench, run, talker, MATCH_S)
        if not talker.subscribers:
            return Trial(run.trace(), spins=match.spins)
        trial = await _send_all(bench, run, talker, match, numbers, UNTIMED_HZ)
        return await _collect_last_logs(run, replace(trial, before_break=min(len(trial.sent), 1)), match)


@repeat_if_doubtful
async def fast(bench: Bench) -> Trial:
    """Send messages as fast as a typical sensor for a short while; then press Ctrl+C."""
    async with bench.start(FILE, expected_s=FAST_EXPECTED_S) as run, run.publisher(TOPIC, TYPE) as talker:
        match = await _wait_for_match(bench, run, talker, MATCH_S)
        if not talker.subscribers:
            return Trial(run.trace(), spins=match.spins, ending=await run.interrupt())
        first = random.randint(0, 50)
        trial = await _send_all(bench, run, talker, match, range(first, first + FAST_MESSAGES), FAST_HZ)
        trial = await _collect_last_logs(run, trial, match)
        bench.report_progress(0.95, "pressing Ctrl+C")
        return replace(trial, ending=await run.interrupt())


async def restart(bench: Bench) -> Trial:
    """Send messages, remove the publisher, and let a new one start over at 0, at another rate."""
    async with bench.start(FILE) as run:
        sent: list[Sent] = []
        async with run.publisher(TOPIC, TYPE) as talker:
            match = await _wait_for_match(bench, run, talker, MATCH_S)
            if not talker.subscribers:
                return Trial(run.trace(), spins=match.spins)
            waited_before_s = run.node_cpu_wait_s()
            # Low enough that the second publisher repeats numbers of the first: a node that takes those for duplicates
            # fails.
            first = random.randint(3, 6)
            await _send(bench, run, talker, sent, range(first, first + RESTART_AFTER), match.hz(UNTIMED_HZ))
            await _pause(run, SOON_S / 2)
            left_at = run.now()  # taken before it leaves, since the node may log that immediately
        await _pause(run, ABSENT_S)
        async with run.publisher(TOPIC, TYPE) as talker:
            await run.until(lambda: talker.subscribers > 0, SPIN_S)
            if talker.subscribers:
                await _pause(run, MATCH_S)
                await _send(bench, run, talker, sent, range(RESTART_MESSAGES - RESTART_AFTER), match.hz(RESTARTED_HZ))
            cpu_wait_s = run.node_cpu_wait_s() - waited_before_s
            before_break = RESTART_AFTER if len(sent) >= RESTART_AFTER else 0
            trial = Trial(run.trace(), tuple(sent), before_break, left_at, cpu_wait_s, match.spins)
            return await _collect_last_logs(run, trial, match)


@dataclass(frozen=True)
class _Match:
    """What is known of a node once our publisher and its subscription are matched.

    `spins`: whether it answered a request. `is_stuck`: whether another start shows that it waits for ever.
    """

    spins: bool
    is_stuck: bool = False

    def hz(self, usual_hz: float) -> float:
        """The rate at which to send messages: it makes no difference to a node that waits for ever."""
        return STUCK_HZ if self.is_stuck else usual_hz


async def _wait_for_match(bench: Bench, run: Run, talker: Publisher, settled_s: float) -> _Match:
    """Wait until our publisher and the subscription are matched, and see whether the node answers a request."""

    def has_subscription() -> bool:
        return any((each.topic, each.type) == (TOPIC, TYPE) for each in run.graph.subscriptions)

    await wait_until_seen(
        run,
        lambda: talker.subscribers > 0,
        promised=has_subscription,
        message_gap_s=1.0,
        settle_s=lambda: patience_s(((each.topic, each.type) for each in run.graph.subscriptions), TOPIC, TYPE),
    )
    matched_at = run.now()
    if run.exit is not None:
        return _Match(spins=True)
    await run.until(lambda: bool(run.graph.parameter_nodes), 1.0)
    if not run.graph.parameter_nodes:
        answered = True
    else:
        answer, is_stuck = await ask_unless_stuck(run, SPIN_S, lambda: bench.facts(_dump_stuck_node))
        if is_stuck:
            return _Match(spins=False, is_stuck=True)
        answered = answer is not None
    await _pause(run, matched_at + settled_s - run.now())
    return _Match(answered)


async def _send_all(
    bench: Bench, run: Run, talker: Publisher, match: _Match, numbers: Iterable[int], usual_hz: float
) -> Trial:
    """Send a message for each number, and return the trial so far."""
    waited_before_s, matches = run.node_cpu_wait_s(), talker.matches
    sent: list[Sent] = []
    await _send(bench, run, talker, sent, numbers, match.hz(usual_hz))
    return Trial(
        run.trace(),
        tuple(sent),
        cpu_wait_s=run.node_cpu_wait_s() - waited_before_s,
        spins=match.spins,
        new_subscriptions=talker.matches - matches,
    )


async def _send(bench: Bench, run: Run, talker: Publisher, sent: list[Sent], numbers: Iterable[int], hz: float) -> None:
    """Send a message for each number at a steady rate, and append it to `sent`; stop if the node has ended."""
    due = max(sent[-1].at + 1 / hz, run.now()) if sent else run.now()
    for number in numbers:
        # Catch up after a delay, but never send two at once, which would be no steady rate.
        earliest = sent[-1].at + 0.5 / hz if sent else due
        await _pause(run, max(due, earliest) - run.now())
        due += 1 / hz
        if run.exit is not None:
            return
        sample = talker.publish({"data": f"Hello World: {number}"})
        sent.append(Sent(number, sample.source_time, run.node_cpu_wait_s()))
        bench.report_progress(0.1 + 0.04 * min(len(sent), 20), f"sending “Hello World: {number}”")


async def _pause(run: Run, for_s: float) -> None:
    """Wait as a talker does between two messages."""
    until = run.now() + for_s
    if for_s > 0:
        await run.until(lambda: run.now() >= until, for_s)


async def _collect_last_logs(run: Run, trial: Trial, match: _Match) -> Trial:
    """Wait for the last summary, and then until the log is quiet, each within a limit."""
    if match.is_stuck:
        return trial

    def current() -> Trial:
        return replace(trial, trace=run.trace())

    last = last_due_count(len(trial.sent))

    def has_last_summary() -> bool:
        return any(summary.messages >= last for summary in find_summaries(current()))

    if last:
        # From the last message on: a node that restarts its count for a new publisher logs its summary later.
        await run.until(has_last_summary, max(trial.sent[-1].at + trial.summary_limit_s - run.now(), 0.0))
    if trial.jumps:
        jumped_at = trial.sent[trial.jumps[-1]].at
        await run.until(
            lambda: _logs_something_new(jumped_at, current()), max(jumped_at + trial.summary_limit_s - run.now(), 0.0)
        )
    await wait_until_log_quiet(run, quiet_s=LINE_GAP_S, max_s=LOG_QUIET_LIMIT_S)
    return current()


def _logs_something_new(jumped_at: float, trial: Trial) -> bool:
    """Whether a line was logged since `jumped_at` of a kind that is no summary's, nor logged before the first jump."""
    usual_kinds = {line.kind for line in trial.lines if line.messages <= trial.before_break}
    usual_kinds |= {line.kind for summary in find_summaries(trial) for line in summary.lines}
    return any(line.at >= jumped_at and line.kind not in usual_kinds for line in trial.lines)


async def _dump_stuck_node(bench: Bench) -> tuple[Frame, ...]:
    """Start the node once more, only to dump its stacks while it does not respond."""
    async with bench.start(FILE) as run, run.publisher(TOPIC, TYPE) as talker:
        bench.report_progress(0.9, "looking where the node is stuck")
        await wait_until_seen(run, lambda: talker.subscribers > 0)
        talker.publish({"data": "Hello World: 0"})
        await _pause(run, STUCK_S)
        return await run.dump_stacks()
