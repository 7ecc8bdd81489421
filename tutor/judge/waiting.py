"""Waits that several checks share: for a node to come up, and for enough messages to tell a rate."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from tutor.errors import MachineTooBusy
from tutor.judge.bench import Bench, Run
from tutor.judge.rates import TOLERANCE, Rate, measure
from tutor.judge.tracebacks import Frame

START_S = 15.0
"""A process on a slow, busy machine may need this long to come up."""

SETTLE_S = 5.0
"""A node that is up does what it does within this time, a pause of 2 s at its start included."""

OTHER_TYPE_S = 1.0
"""An endpoint of the right name, but another type, is the one that the node has: two would be in each other's way."""

OTHER_NAME_S = 2.5
"""A node that has an endpoint of the right type, but another name, has all that it will have within this time, a pause
of 2 s included."""

RARE_S = 12.0
"""A publisher that exists may wait this long between messages."""

AGAIN_S = 3.5
"""A second listen is at least this long, so that a rate of 1 Hz, too, can be recognised."""

IDLE_S = 0.7
"""What a node has sent before it fell idle has come in by then."""

NO_NODE_S = 2.0
"""A node whose process has been idle for this long would be in the graph."""

RESENT_S = 3.5
"""A message that is lost on its way is sent again within 3 s, at its writer's next heartbeat (Fast DDS's default).

What an idle process has done, or would do for what was sent to it, is seen by then, the graph included.
"""

STUCK_S = 1.5
"""A node that is up has run into what it waits for within this time."""

TRIES = 3
CPU_WAIT_SHARE = 0.2
"""Being kept from running for less than this share of the time hardly shows in a rate."""


IN_FLIGHT_S = 0.1
"""A message takes less than this from its source to us."""


async def wait_until_seen(
    run: Run,
    seen: Callable[[], bool],
    *,
    promised: Callable[[], bool] = lambda: False,
    rare_s: float = RARE_S,
    idle_s: float = RESENT_S,
    settle_s: Callable[[], float] = lambda: SETTLE_S,
) -> bool:
    """Wait until `seen()`; give up when the process ends, never makes a node, or its node does nothing of the kind.

    `promised()`: something announces that it will come, such as a publisher on the topic; then `rare_s` more seconds
    are waited for it. `idle_s`: give up, too, when the node has been idle for that long (see `Run.until`); leave it as
    it is for what is in the graph, which may reach us later than it is done. `settle_s()`: how much
    longer, by what is known of the node now, something may take to be seen or promised; `SETTLE_S` in all, at most.
    """
    if await run.until(lambda: seen() or bool(run.graph.nodes), START_S, idle_s=NO_NODE_S) and not seen():
        limit_s, since, cpu_wait_s = SETTLE_S, run.now(), run.node_cpu_wait_s()

        def settled() -> bool:
            nonlocal limit_s, since, cpu_wait_s
            if (now_s := settle_s()) != limit_s:  # what says so has just come, and more may come with it
                limit_s, since, cpu_wait_s = now_s, run.now(), run.node_cpu_wait_s()
            return run.now() - since - (run.node_cpu_wait_s() - cpu_wait_s) >= limit_s

        await run.until(lambda: seen() or promised() or settled(), SETTLE_S, idle_s=idle_s)
        if not seen() and not promised():
            return False
        if not seen():
            await run.until(seen, rare_s, idle_s=idle_s)
    return seen()


def patience_s(there: Iterable[tuple[str, str]], name: str, type_name: str) -> float:
    """How long to wait for an endpoint of this name and type, when the node has `there`, as (name, type) each."""
    others = [other for other, kind in there if (other == name) != (kind == type_name)]
    if name in others:
        return OTHER_TYPE_S
    return OTHER_NAME_S if others else SETTLE_S


async def wait_for_message(run: Run, topic: str, type_name: str, *, rare_s: float = RARE_S) -> bool:
    """Wait for a message of this type on this (watched) topic."""
    return await wait_until_seen(
        run,
        lambda: bool(run.samples_on(topic)),
        promised=lambda: any(p.topic == topic and p.type == type_name for p in run.graph.publishers),
        rare_s=rare_s,
        idle_s=IDLE_S,
        settle_s=lambda: _publisher_patience_s(run, topic, type_name),
    )


async def wait_for_publisher(run: Run, topic: str, type_name: str) -> bool:
    """Wait for a publisher on this topic; of another type, it is the one that the node has."""
    return await wait_until_seen(
        run,
        lambda: any(publisher.topic == topic for publisher in run.graph.publishers),
        settle_s=lambda: _publisher_patience_s(run, topic, type_name),
    )


def _publisher_patience_s(run: Run, topic: str, type_name: str) -> float:
    return patience_s(((each.topic, each.type) for each in run.graph.publishers), topic, type_name)


async def find_stuck_frames(bench: Bench, file: str) -> tuple[Frame, ...]:
    """Start a node that answered nothing once more, only to see where its threads are: innermost frames first."""
    async with bench.start(file) as run:
        bench.report_progress(0.9, "looking where the node is stuck")
        await run.until(lambda: bool(run.graph.nodes), START_S)
        await run.until(lambda: run.exit is not None, STUCK_S)
        return await run.dump_stacks()


async def wait_until_log_quiet(run: Run, *, quiet_s: float, most_s: float) -> None:
    """Wait until nothing has been logged for `quiet_s`, or for `most_s` where a node logs without end."""
    seen, until = -1, run.now() + most_s
    while len(run.logs) != seen and run.now() < until:
        seen = len(run.logs)
        await run.until(lambda seen=seen: len(run.logs) != seen, quiet_s)  # type: ignore[misc]


def window_s(hz: float) -> float:
    """How many seconds of messages it takes to tell this rate: two periods at least, and one second."""
    return max(1.0, (2.0 if hz < 1 else 3.0) / hz)


async def measure_steady_rate(run: Run, topic: str, asked_hz: float, *, since: float) -> tuple[Rate | None, int]:
    """The rate on `topic` from source time `since` on, and the number of messages it is taken from.

    Listens for as long as `asked_hz` needs. Where what it hears does not agree, it listens once more, and longer, and
    judges by that second stretch alone: a hiccup in the first is the machine's, a rate that stays wrong the learner's.
    Raises MachineTooBusy where the machine hardly lets the node run, however often it is listened to.
    """
    start, for_s = max(since, run.now()), window_s(asked_hz) + 0.5 / asked_hz
    rate, messages = await _listen(run, topic, start, for_s)
    for _ in range(TRIES):
        if rate is not None and rate.agrees(asked_hz):
            break
        for_s, cpu_wait_s = max(window_s(asked_hz), AGAIN_S), run.node_cpu_wait_s()
        rate, messages = await _listen(run, topic, run.now(), for_s)
        if not too_few_by_cpu_wait(messages, asked_hz, cpu_wait_s=run.node_cpu_wait_s() - cpu_wait_s, of_s=for_s):
            break
    else:
        if rate is None or not rate.agrees(asked_hz):
            raise MachineTooBusy("this machine is too busy to measure a rate")
    return rate, messages


def too_few_by_cpu_wait(messages: int, asked_hz: float, *, cpu_wait_s: float, of_s: float) -> bool:
    """Whether so few messages in `of_s` may be so only because the machine kept the node from running for `cpu_wait_s`.

    Too many messages are never excused.
    """
    if cpu_wait_s < CPU_WAIT_SHARE * of_s:
        return False
    mean_hz = max(messages, 1) / of_s
    ran = max(0.05, 1 - cpu_wait_s / of_s)
    return mean_hz <= asked_hz and mean_hz / ran >= (1 - TOLERANCE) * asked_hz


async def _listen(run: Run, topic: str, start: float, for_s: float) -> tuple[Rate | None, int]:
    end, late_s = start + for_s, run.our_cpu_wait_s()
    await run.until(lambda: run.now() >= end + IN_FLIGHT_S + run.our_cpu_wait_s() - late_s, for_s + 2)
    samples = [sample for sample in run.samples_on(topic) if start <= sample.source_time <= end]
    return measure(samples), len(samples)
