"""I1.2: what is done to the node."""

from __future__ import annotations

import random
from collections.abc import Awaitable, Callable, Iterable
from contextlib import suppress
from dataclasses import replace

from checks.i1_2 import backlog, continuity, judges
from checks.i1_2.facts import (
    AGAIN_AFTER,
    AWAY_S,
    FAST_HZ,
    FAST_MESSAGES,
    FILE,
    JUMP_AFTER,
    JUMP_MESSAGES,
    MEET_S,
    QUIET_S,
    RESTART_AFTER,
    RESTART_MESSAGES,
    ROUGH_S,
    SOON_S,
    SOONER_HZ,
    STEADY_HZ,
    STEADY_MESSAGES,
    TOPIC,
    TYPE,
    Feeding,
    Sent,
)
from checks.i1_2.reports import find, milestone
from tutor.judge.bench import Bench, Feed, MachineTooBusy, Run
from tutor.judge.ending import confirmed
from tutor.judge.tracebacks import Frame
from tutor.judge.waiting import TRIES, appears, heard_out

SPIN_S = 2.0
"""A node that is subscribed and spins answers a request within this time; for one that sleeps first, twice as long."""

SAID_S = 0.15
"""What belongs to one summary is logged within this time, each line after the other."""

MOST_SAID_S = 1.0
"""A node that goes on logging for ever is not heard out longer than this."""

STUCK_S = 1.5

FAST_ASKS_S = MEET_S + FAST_MESSAGES / FAST_HZ


@confirmed
async def steady(bench: Bench) -> Feeding:
    """Feed it evenly from 0 on, then press Ctrl+C."""

    async def once() -> Feeding:
        async with bench.start(FILE) as run, run.publisher(TOPIC, TYPE) as feed:
            bench.doing(0.05, "waiting for the subscription")
            spins = await _meet(run, feed, QUIET_S)
            if not feed.subscribers:
                return Feeding(run.trace(), spins=spins, ending=await run.interrupt() if run.exit is None else None)
            starved = run.starved_s()
            sent: list[Sent] = []
            await _send(bench, run, feed, sent, range(STEADY_MESSAGES), random.uniform(*STEADY_HZ))
            fed = Feeding(run.trace(), tuple(sent), starved_s=run.starved_s() - starved, spins=spins)
            fed = await _hear_out(run, fed)
            bench.doing(0.95, "pressing Ctrl+C")
            return replace(fed, ending=await run.interrupt() if run.exit is None else None)

    async def fair(fed: Feeding) -> bool:
        nothing = replace(fed, sent=())
        of_steady = (judges.judge_slow_count, judges.judge_rate, judges.judge_slow_summary)
        with suppress(MachineTooBusy):
            return all(judge(fed, nothing).passed for judge in of_steady)
        return False

    fed = await _fairly(once, fair)
    if fed.sent and not fed.spins and not fed.lines and fed.trace.exit is None:
        return replace(fed, stuck=await _stuck(bench))
    return fed


async def jump(bench: Bench) -> Feeding:
    """Feed it from some number on, and leave some out; later, leave out one more."""

    async def once() -> Feeding:
        async with bench.start(FILE) as run, run.publisher(TOPIC, TYPE) as feed:
            spins = await _meet(run, feed, MEET_S)
            if not feed.subscribers:
                return Feeding(run.trace(), spins=spins)
            starved = run.starved_s()
            sent: list[Sent] = []
            # Past 100 before the jump: who compares texts, or the last two digits, is mistaken there.
            first = random.randint(90, 97)
            skipped = first + JUMP_AFTER + random.randint(4, 8)
            await _send(bench, run, feed, sent, range(first, first + JUMP_AFTER), SOONER_HZ)
            until = skipped + AGAIN_AFTER - JUMP_AFTER
            await _send(bench, run, feed, sent, range(skipped, until), SOONER_HZ)
            await _send(bench, run, feed, sent, range(until + 1, until + 1 + JUMP_MESSAGES - AGAIN_AFTER), SOONER_HZ)
            breaks, again = (after if len(sent) > after else 0 for after in (JUMP_AFTER, AGAIN_AFTER))
            lost = run.starved_s() - starved
            fed = Feeding(run.trace(), tuple(sent), breaks, starved_s=lost, spins=spins, again=again)
            return await _hear_out(run, fed)

    async def fair(fed: Feeding) -> bool:
        even = await bench.facts(steady)
        told = bool(fed.breaks) and continuity.judge_gaps(fed, even).passed
        return told and judges.judge_slow_count(even, fed).passed and judges.judge_slow_summary(even, fed).passed

    return await _fairly(once, fair)


async def fast(bench: Bench) -> Feeding:
    """Feed it for a short while as fast as many a sensor does."""

    async def once() -> Feeding:
        async with bench.start(FILE, asks_s=FAST_ASKS_S) as run, run.publisher(TOPIC, TYPE) as feed:
            spins = await _meet(run, feed, MEET_S)
            if not feed.subscribers:
                return Feeding(run.trace(), spins=spins)
            starved = run.starved_s()
            sent: list[Sent] = []
            first = random.randint(0, 50)
            await _send(bench, run, feed, sent, range(first, first + FAST_MESSAGES), FAST_HZ)
            lost = run.starved_s() - starved
            return await _hear_out(run, Feeding(run.trace(), tuple(sent), starved_s=lost, spins=spins))

    async def fair(fed: Feeding) -> bool:
        even = await bench.facts(steady)
        whole = backlog.lost(fed, even) is None and not backlog.missing_summary(fed, even)
        return whole and backlog.fast_enough(fed)

    return await _fairly(once, fair)


async def restart(bench: Bench) -> Feeding:
    """Feed it, take the publisher away, and let another one start over at 0."""

    async def once() -> Feeding:
        async with bench.start(FILE) as run:
            sent: list[Sent] = []
            async with run.publisher(TOPIC, TYPE) as feed:
                spins = await _meet(run, feed, MEET_S)
                if not feed.subscribers:
                    return Feeding(run.trace(), spins=spins)
                starved = run.starved_s()
                # So low that the second publisher sends again what has come before: who takes that for repeated, fails.
                first = random.randint(3, 6)
                await _send(bench, run, feed, sent, range(first, first + RESTART_AFTER), SOONER_HZ)
                await _pause(run, SOON_S / 2)
                gone_at = run.now()  # before it goes: the node may tell of that at once
            await _pause(run, AWAY_S)
            async with run.publisher(TOPIC, TYPE) as feed:
                await run.until(lambda: feed.subscribers > 0, SPIN_S)
                if feed.subscribers:
                    await _pause(run, MEET_S)
                    again = RESTART_MESSAGES - RESTART_AFTER
                    await _send(bench, run, feed, sent, range(again), SOONER_HZ)
                lost = run.starved_s() - starved
                breaks = RESTART_AFTER if len(sent) >= RESTART_AFTER else 0
                return await _hear_out(run, Feeding(run.trace(), tuple(sent), breaks, gone_at, lost, spins))

    async def fair(fed: Feeding) -> bool:
        return continuity.judge_restart(fed, await bench.facts(steady), await bench.facts(jump)).passed

    return await _fairly(once, fair)


async def _fairly(once: Callable[[], Awaitable[Feeding]], fair: Callable[[Feeding], Awaitable[bool]]) -> Feeding:
    """Try again where the node did not do well, and the machine may be to blame."""
    for _ in range(TRIES):
        fed = await once()
        if max(fed.starved_s, fed.held_up_s) < ROUGH_S or not fed.sent or await fair(fed):
            break
    return fed


async def _meet(run: Run, feed: Feed, settled_s: float) -> bool:
    """Wait for the subscription, and until the node takes in what comes. Gives whether it answered a request."""

    def announced() -> bool:
        return any((each.topic, each.type) == (TOPIC, TYPE) for each in run.graph.subscriptions)

    await appears(run, lambda: feed.subscribers > 0, promised=announced, rare_s=1.0)
    met_at = run.now()
    if run.exit is not None:
        return True
    await run.until(lambda: any(_is_parameters(each.type) for each in run.graph.services), 1.0)
    answered = await run.parameters(SPIN_S) is not None or not any(
        _is_parameters(each.type) for each in run.graph.services
    )
    await _pause(run, met_at + settled_s - run.now())
    return answered


def _is_parameters(type_name: str) -> bool:
    return type_name == "rcl_interfaces/srv/ListParameters"


async def _send(bench: Bench, run: Run, feed: Feed, sent: list[Sent], numbers: Iterable[int], hz: float) -> None:
    """Send a message for each number, evenly; stop when the node has ended."""
    due = sent[-1].at + 1 / hz if sent else run.now()
    for number in numbers:
        # Where we were late, the next ones are not: but two at once would be no even rate.
        soonest = sent[-1].at + 0.5 / hz if sent else due
        await _pause(run, max(due, soonest) - run.now())
        due += 1 / hz
        if run.exit is not None:
            return
        sample = feed.publish({"data": f"Hello World: {number}"})
        sent.append(Sent(number, sample.source_time, run.starved_s()))
        bench.doing(0.1 + 0.04 * min(len(sent), 20), f"sending “Hello World: {number}”")


async def _pause(run: Run, for_s: float) -> None:
    """Let time go by, as a talker does between its messages."""
    until = run.now() + for_s
    if for_s > 0:
        await run.until(lambda: run.now() >= until, for_s)


async def _hear_out(run: Run, fed: Feeding) -> Feeding:
    """Wait for the last summary, and until nothing more is logged, or for a while where that never ends."""

    def now() -> Feeding:
        return replace(fed, trace=run.trace())

    last = milestone(len(fed.sent))

    def told() -> bool:
        return any(report.messages >= last for report in find(now()))

    if last:
        # From the last message on: who counts anew for a new publisher is due later than others.
        await run.until(told, max(fed.sent[-1].at + fed.late_s - run.now(), 0.0))
    if fed.jumps:
        jumped_at = fed.sent[fed.jumps[-1]].at
        await run.until(lambda: _speaks_since(jumped_at, now()), max(jumped_at + fed.late_s - run.now(), 0.0))
    await heard_out(run, quiet_s=SAID_S, most_s=MOST_SAID_S)
    return now()


def _speaks_since(jumped_at: float, fed: Feeding) -> bool:
    """Whether it has said something since the jump that it did not say before the first one."""
    calm = {line.kind for line in fed.lines if line.messages <= fed.breaks}
    return any(line.at >= jumped_at and line.kind not in calm for line in fed.lines)


async def _stuck(bench: Bench) -> tuple[Frame, ...]:
    """Start it once more, only to see where it is while it answers nothing."""
    async with bench.start(FILE) as run, run.publisher(TOPIC, TYPE) as feed:
        bench.doing(0.9, "looking where the node is stuck")
        await appears(run, lambda: feed.subscribers > 0)
        feed.publish({"data": "Hello World: 0"})
        await _pause(run, STUCK_S)
        return await run.stuck_at()
