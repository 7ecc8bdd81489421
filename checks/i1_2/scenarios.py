"""I1.2: what is done to the node."""

from __future__ import annotations

import random
from collections.abc import Iterable
from dataclasses import replace

from checks.i1_2.facts import (
    ABSENT_S,
    AGAIN_AFTER,
    FAST_HZ,
    FAST_MESSAGES,
    FILE,
    JUMP_AFTER,
    JUMP_MESSAGES,
    MATCH_S,
    QUIET_S,
    RESTART_AFTER,
    RESTART_MESSAGES,
    SOON_S,
    SOONER_HZ,
    STEADY_HZ,
    STEADY_MESSAGES,
    TOPIC,
    TYPE,
    Sent,
    Trial,
)
from checks.i1_2.summaries import find_summaries, milestone
from tutor.judge.bench import Bench, Publisher, Run
from tutor.judge.ending import repeat_if_doubtful
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import patience_s, wait_until_log_quiet, wait_until_seen

SPIN_S = 2.0
"""A node that is subscribed and spins answers a request within this time; for one that sleeps first, twice as long."""

SAID_S = 0.15
"""What belongs to one summary is logged within this time, each line after the other."""

MOST_SAID_S = 1.0
"""A node that goes on logging forever is not waited for longer than this."""

STUCK_S = 1.5

FAST_ASKS_S = MATCH_S + FAST_MESSAGES / FAST_HZ


@repeat_if_doubtful
async def steady(bench: Bench) -> Trial:
    """Feed it evenly from 0 on, then press Ctrl+C."""
    async with bench.start(FILE) as run, run.publisher(TOPIC, TYPE) as talker:
        bench.report_progress(0.05, "waiting for the subscription")
        spins = await _wait_for_match(run, talker, QUIET_S)
        if not talker.subscribers:
            return Trial(run.trace(), spins=spins, ending=await run.interrupt() if run.exit is None else None)
        waited_s = run.node_cpu_wait_s()
        sent: list[Sent] = []
        await _send(bench, run, talker, sent, range(STEADY_MESSAGES), random.uniform(*STEADY_HZ))
        trial = Trial(run.trace(), tuple(sent), cpu_wait_s=run.node_cpu_wait_s() - waited_s, spins=spins)
        trial = await _collect_last_logs(run, trial)
        bench.report_progress(0.95, "pressing Ctrl+C")
        trial = replace(trial, ending=await run.interrupt() if run.exit is None else None)
    if trial.sent and not trial.spins and not trial.lines and trial.trace.exit is None:
        return replace(trial, stuck=await _stuck(bench))
    return trial


async def jump(bench: Bench) -> Trial:
    """Feed it from some number on, and leave some out; later, leave out one more."""
    async with bench.start(FILE) as run, run.publisher(TOPIC, TYPE) as talker:
        spins = await _wait_for_match(run, talker, MATCH_S)
        if not talker.subscribers:
            return Trial(run.trace(), spins=spins)
        waited_s = run.node_cpu_wait_s()
        sent: list[Sent] = []
        # Past 100 before the jump: a node that compares texts, or the last two digits, goes wrong there.
        first = random.randint(94, 97)
        skipped = first + JUMP_AFTER + random.randint(4, 8)
        await _send(bench, run, talker, sent, range(first, first + JUMP_AFTER), SOONER_HZ)
        until = skipped + AGAIN_AFTER - JUMP_AFTER
        await _send(bench, run, talker, sent, range(skipped, until), SOONER_HZ)
        await _send(bench, run, talker, sent, range(until + 1, until + 1 + JUMP_MESSAGES - AGAIN_AFTER), SOONER_HZ)
        breaks, again = (after if len(sent) > after else 0 for after in (JUMP_AFTER, AGAIN_AFTER))
        lost = run.node_cpu_wait_s() - waited_s
        trial = Trial(run.trace(), tuple(sent), breaks, cpu_wait_s=lost, spins=spins, again=again)
        return await _collect_last_logs(run, trial)


async def fast(bench: Bench) -> Trial:
    """Feed it for a short while as fast as many a sensor does."""
    async with bench.start(FILE, expected_s=FAST_ASKS_S) as run, run.publisher(TOPIC, TYPE) as talker:
        spins = await _wait_for_match(run, talker, MATCH_S)
        if not talker.subscribers:
            return Trial(run.trace(), spins=spins)
        waited_s = run.node_cpu_wait_s()
        sent: list[Sent] = []
        first = random.randint(0, 50)
        await _send(bench, run, talker, sent, range(first, first + FAST_MESSAGES), FAST_HZ)
        lost = run.node_cpu_wait_s() - waited_s
        return await _collect_last_logs(run, Trial(run.trace(), tuple(sent), cpu_wait_s=lost, spins=spins))


async def restart(bench: Bench) -> Trial:
    """Feed it, take the publisher away, and let another one start over at 0."""
    async with bench.start(FILE) as run:
        sent: list[Sent] = []
        async with run.publisher(TOPIC, TYPE) as talker:
            spins = await _wait_for_match(run, talker, MATCH_S)
            if not talker.subscribers:
                return Trial(run.trace(), spins=spins)
            waited_s = run.node_cpu_wait_s()
            # So low that the second publisher sends again what has come before: a node that takes that for a
            # repetition fails.
            first = random.randint(3, 6)
            await _send(bench, run, talker, sent, range(first, first + RESTART_AFTER), SOONER_HZ)
            await _pause(run, SOON_S / 2)
            gone_at = run.now()  # before it goes: the node may log that at once
        await _pause(run, ABSENT_S)
        async with run.publisher(TOPIC, TYPE) as talker:
            await run.until(lambda: talker.subscribers > 0, SPIN_S)
            if talker.subscribers:
                await _pause(run, MATCH_S)
                again = RESTART_MESSAGES - RESTART_AFTER
                await _send(bench, run, talker, sent, range(again), SOONER_HZ)
            lost = run.node_cpu_wait_s() - waited_s
            breaks = RESTART_AFTER if len(sent) >= RESTART_AFTER else 0
            return await _collect_last_logs(run, Trial(run.trace(), tuple(sent), breaks, gone_at, lost, spins))


async def _wait_for_match(run: Run, talker: Publisher, settled_s: float) -> bool:
    """Wait for the subscription, and until the node takes in what comes. Gives whether it answered a request."""

    def announced() -> bool:
        return any((each.topic, each.type) == (TOPIC, TYPE) for each in run.graph.subscriptions)

    await wait_until_seen(
        run,
        lambda: talker.subscribers > 0,
        promised=announced,
        rare_s=1.0,
        settle_s=lambda: patience_s(((each.topic, each.type) for each in run.graph.subscriptions), TOPIC, TYPE),
    )
    met_at = run.now()
    if run.exit is not None:
        return True
    await run.until(lambda: bool(run.graph.parameter_nodes), 1.0)
    answered = await run.parameters(SPIN_S) is not None or not run.graph.parameter_nodes
    await _pause(run, met_at + settled_s - run.now())
    return answered


async def _send(bench: Bench, run: Run, talker: Publisher, sent: list[Sent], numbers: Iterable[int], hz: float) -> None:
    """Send a message for each number, evenly; stop when the node has ended."""
    due = sent[-1].at + 1 / hz if sent else run.now()
    for number in numbers:
        # Where we were late, the next ones are not: but two at once would be no even rate.
        soonest = sent[-1].at + 0.5 / hz if sent else due
        await _pause(run, max(due, soonest) - run.now())
        due += 1 / hz
        if run.exit is not None:
            return
        sample = talker.publish({"data": f"Hello World: {number}"})
        sent.append(Sent(number, sample.source_time, run.node_cpu_wait_s()))
        bench.report_progress(0.1 + 0.04 * min(len(sent), 20), f"sending “Hello World: {number}”")


async def _pause(run: Run, for_s: float) -> None:
    """Let time go by, as a talker does between its messages."""
    until = run.now() + for_s
    if for_s > 0:
        await run.until(lambda: run.now() >= until, for_s)


async def _collect_last_logs(run: Run, trial: Trial) -> Trial:
    """Wait for the last summary, and until nothing more is logged, or for a while where that never ends."""

    def now() -> Trial:
        return replace(trial, trace=run.trace())

    last = milestone(len(trial.sent))

    def told() -> bool:
        return any(summary.messages >= last for summary in find_summaries(now()))

    if last:
        # From the last message on: a node that starts counting again for a new publisher is due later than others.
        await run.until(told, max(trial.sent[-1].at + trial.summary_limit_s - run.now(), 0.0))
    if trial.jumps:
        jumped_at = trial.sent[trial.jumps[-1]].at
        await run.until(
            lambda: _speaks_since(jumped_at, now()), max(jumped_at + trial.summary_limit_s - run.now(), 0.0)
        )
    await wait_until_log_quiet(run, quiet_s=SAID_S, most_s=MOST_SAID_S)
    return now()


def _speaks_since(jumped_at: float, trial: Trial) -> bool:
    """Whether it has said something since the jump that it did not say before the first one."""
    calm = {line.kind for line in trial.lines if line.messages <= trial.breaks}
    return any(line.at >= jumped_at and line.kind not in calm for line in trial.lines)


async def _stuck(bench: Bench) -> tuple[Frame, ...]:
    """Start it once more, only to see where it is while it answers nothing."""
    async with bench.start(FILE) as run, run.publisher(TOPIC, TYPE) as talker:
        bench.report_progress(0.9, "looking where the node is stuck")
        await wait_until_seen(run, lambda: talker.subscribers > 0)
        talker.publish({"data": "Hello World: 0"})
        await _pause(run, STUCK_S)
        return await run.dump_stacks()
