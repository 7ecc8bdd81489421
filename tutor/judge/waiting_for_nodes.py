"""Waits shared by several checks: for a node to come up, and for enough messages to measure a rate."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from tutor.errors import MachineTooBusy
from tutor.judge.bench import Bench, Run
from tutor.judge.rates import TOLERANCE, Rate, are_even, measure
from tutor.judge.trace import Sample
from tutor.judge.tracebacks import Frame

START_S = 15.0
"""Time limit for a node to come up, generous enough for a slow, busy machine."""

SETTLE_S = 5.0
"""Time within which a node that is up shows what it does, even if it pauses for 2 s at its start."""

OTHER_TYPE_S = 1.0
"""Patience once an endpoint has the right name but the wrong type: no second one is to be expected on that name."""

OTHER_NAME_S = 2.5
"""Patience once an endpoint has the right type but the wrong name: all others appear within this time, even if the node
pauses for 2 s."""

MESSAGE_GAP_S = 12.0
"""Time that an existing publisher may take between messages."""

FLOOD_MESSAGES, FLOOD_FACTOR = 20, 5
"""A node floods its topic if it sends this many messages, and this many times as many as asked for on top."""

REMEASURE_S = 3.5
"""Minimum length of a repeated rate measurement, long enough to recognise a rate of 1 Hz."""

IDLE_S = 0.7
"""Time after which everything that a node sent before it fell idle has arrived."""

NO_NODE_S = 2.0
"""Once a process has been idle for this long, any node that it created would be in the graph."""

RESENT_S = 3.5
"""A lost message is resent within 3 s, at its writer's next heartbeat (Fast DDS's default).

After this time, everything that an idle process did, or would do in response to us, has been observed, including
changes to the graph. `Run.until` waits for less if nothing was lost.
"""

STUCK_S = 1.5
"""Time within which a node that is up has reached the call that blocks it."""

TRIES = 3
CPU_WAIT_SHARE = 0.2
"""Waiting for a CPU for less than this share of the time hardly affects a rate."""

HARDLY_WAITED_SHARE = 0.05
"""Waiting for a CPU for less than this share of the time does not affect a rate at all."""

IN_FLIGHT_S = 0.1
"""Upper bound on the latency of a message from its source to us."""


async def wait_until_seen(
    run: Run,
    seen: Callable[[], bool],
    *,
    promised: Callable[[], bool] = lambda: False,
    message_gap_s: float = MESSAGE_GAP_S,
    idle_s: float = RESENT_S,
    settle_s: Callable[[], float] = lambda: SETTLE_S,
) -> bool:
    """Wait until `seen()`; give up if the process ends, never creates a node, or its node shows no sign of it in time.

    `promised()`: something announces it, such as a publisher on the topic; then wait up to `message_gap_s` more
    seconds. `idle_s`: also give up once the node has been idle for that long (see `Run.until`); keep the default when
    waiting for a change to the graph, which may reach us late. `settle_s()`: how much longer, given what is known of
    the node now, it may take to be seen or promised; the total is limited to `SETTLE_S`.
    """
    if await run.until(lambda: seen() or bool(run.graph.nodes), START_S, idle_s=NO_NODE_S) and not seen():
        limit_s, since, cpu_wait_s = SETTLE_S, run.now(), run.node_cpu_wait_s()

        def settled() -> bool:
            nonlocal limit_s, since, cpu_wait_s
            if (new_limit_s := settle_s()) != limit_s:  # something has just appeared, and more may follow
                limit_s, since, cpu_wait_s = new_limit_s, run.now(), run.node_cpu_wait_s()
            return run.now() - since - (run.node_cpu_wait_s() - cpu_wait_s) >= limit_s

        await run.until(lambda: seen() or promised() or settled(), SETTLE_S, idle_s=idle_s)
        if not seen() and not promised():
            return False
        if not seen():
            await run.until(seen, message_gap_s, idle_s=idle_s)
    return seen()


def patience_s(present: Iterable[tuple[str, str]], name: str, type_name: str) -> float:
    """How long to wait for an endpoint with this name and type, given the node's present ones as (name, type) pairs."""
    others = [other for other, kind in present if (other == name) != (kind == type_name)]
    if name in others:
        return OTHER_TYPE_S
    return OTHER_NAME_S if others else SETTLE_S


async def wait_for_message(
    run: Run,
    topic: str,
    type_name: str,
    *,
    message_gap_s: float = MESSAGE_GAP_S,
    given_up: Callable[[], bool] = lambda: False,
) -> bool:
    """Wait for a message of this type on this (watched) topic, but no longer once `given_up()`."""
    await wait_until_seen(
        run,
        lambda: bool(run.samples_on(topic)) or given_up(),
        promised=lambda: any(p.topic == topic and p.type == type_name for p in run.graph.publishers),
        message_gap_s=message_gap_s,
        idle_s=IDLE_S,
        settle_s=lambda: _publisher_patience_s(run, topic, type_name),
    )
    return bool(run.samples_on(topic))


async def wait_for_publisher(run: Run, topic: str, type_name: str) -> bool:
    """Wait for a publisher on this topic, of whatever type."""
    return await wait_until_seen(
        run,
        lambda: any(publisher.topic == topic for publisher in run.graph.publishers),
        settle_s=lambda: _publisher_patience_s(run, topic, type_name),
    )


def _publisher_patience_s(run: Run, topic: str, type_name: str) -> float:
    return patience_s(((publisher.topic, publisher.type) for publisher in run.graph.publishers), topic, type_name)


async def find_stuck_frames(bench: Bench, file: str) -> tuple[Frame, ...]:
    """Restart a node that did not respond, just to see where its threads are stuck: innermost frames first."""
    async with bench.start(file) as run:
        bench.report_progress(0.9, "looking where the node is stuck")
        await run.until(lambda: bool(run.graph.nodes), START_S)
        await run.until(lambda: run.exit is not None, STUCK_S)
        return await run.dump_stacks()


async def wait_until_log_quiet(run: Run, *, quiet_s: float, max_s: float) -> None:
    """Wait until nothing has been logged for `quiet_s`, but at most for `max_s`, since a node may log forever."""
    seen, until = -1, run.now() + max_s
    while len(run.logs) != seen and run.now() < until:
        seen = len(run.logs)
        await run.until(lambda seen=seen: len(run.logs) != seen, quiet_s)  # type: ignore[misc]


def window_s(hz: float) -> float:
    """How many seconds of messages it takes to measure this rate: at least two periods and one second."""
    return max(1.0, (2.0 if hz < 1 else 3.0) / hz)


async def measure_steady_rate(run: Run, topic: str, asked_hz: float, *, since: float) -> tuple[Rate | None, int]:
    """The rate on `topic` from source time `since` on, and the number of messages that it is based on.

    Measures for as long as `asked_hz` requires, or until the node is idle and so sends nothing more. If the rate does
    not agree, measures on until the messages are enough to show that they are sent evenly. If they are not, only a
    second, longer window counts: a hiccup in the first is the machine's, a rate that stays wrong is the learner's.
    Far too many messages from a node that hardly waits for a CPU are no hiccup either. A flood of them, as from a timer
    with the period 0, is measured no longer than it takes to recognise it.
    Raises MachineTooBusy if the machine hardly lets the node run in any window.
    """
    start, for_s, waited_s = max(since, run.now()), window_s(asked_hz) + 0.5 / asked_hz, run.node_cpu_wait_s()

    def all_samples() -> list[Sample]:
        return [sample for sample in run.samples_on(topic) if sample.source_time >= start]

    def hardly_waited() -> bool:
        return run.node_cpu_wait_s() - waited_s < HARDLY_WAITED_SHARE * (run.now() - start)

    def is_clear() -> bool:
        return hardly_waited() and are_even(all_samples())

    def is_flooded() -> bool:
        return len(all_samples()) >= FLOOD_MESSAGES + FLOOD_FACTOR * asked_hz * (run.now() - start)

    samples = await _samples_in_window(run, topic, start, for_s, is_flooded)
    rate = measure(samples)
    if is_flooded() or (rate is not None and rate.agrees_with(asked_hz)):
        return rate, len(samples)
    if rate is not None and rate.is_far_above(asked_hz, for_s) and hardly_waited():
        return rate, len(samples)
    for _ in range(TRIES):
        for_s, cpu_wait_s = max(window_s(asked_hz), REMEASURE_S), run.node_cpu_wait_s()
        samples = await _samples_in_window(run, topic, run.now(), for_s, is_clear)
        if is_clear():
            return measure(all_samples()), len(all_samples())
        rate = measure(samples)
        if rate is not None and rate.agrees_with(asked_hz):
            break
        cpu_wait_s = run.node_cpu_wait_s() - cpu_wait_s
        if not too_few_by_cpu_wait(len(samples), asked_hz, cpu_wait_s=cpu_wait_s, elapsed_s=for_s):
            break
    else:
        raise MachineTooBusy("this machine is too busy to measure a rate")
    return rate, len(samples)


def cannot_be_slowed(samples: Sequence[Sample], *, cpu_wait_s: float, elapsed_s: float) -> bool:
    """Whether the machine cannot have changed the rate of these samples: they are even, and the node hardly waited."""
    return cpu_wait_s < HARDLY_WAITED_SHARE * elapsed_s and are_even(samples)


def too_few_by_cpu_wait(messages: int, asked_hz: float, *, cpu_wait_s: float, elapsed_s: float) -> bool:
    """Whether the node's wait for a CPU (`cpu_wait_s` of `elapsed_s`) alone may explain why it sent so few messages.

    The machine is never to blame for too many messages.
    """
    if cpu_wait_s < CPU_WAIT_SHARE * elapsed_s:
        return False
    mean_hz = max(messages, 1) / elapsed_s
    running_share = max(0.05, 1 - cpu_wait_s / elapsed_s)
    return mean_hz <= asked_hz and mean_hz / running_share >= (1 - TOLERANCE) * asked_hz


async def _samples_in_window(
    run: Run, topic: str, start: float, for_s: float, enough: Callable[[], bool] = lambda: False
) -> list[Sample]:
    end, late_s = start + for_s, run.our_cpu_wait_s()
    await run.until(
        lambda: enough() or run.now() >= end + IN_FLIGHT_S + run.our_cpu_wait_s() - late_s, for_s + 2, idle_s=IDLE_S
    )
    return [sample for sample in run.samples_on(topic) if start <= sample.source_time <= end]
