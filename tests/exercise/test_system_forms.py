"""What is said of a system of several nodes, on fabricated launches."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import pytest

from tutor.exercise import Endpoint, HasEndpoints, KeepsRate, LeadsTo, Tells, Topic
from tutor.exercise.system_run import Sent, SystemRun
from tutor.judge.symptom import Symptom
from tutor.judge.trace import OutputLine, Sample, Trace
from tutor.judge.verdict import Failure, Status, Verdict
from tutor.ros_model import Graph, QoS, TopicEndpoint

START = 1_000.0

LEVEL = Topic("/tank/level", "std_msgs/msg/Float64")
STATE = Topic("/tank/state", "std_msgs/msg/String")
VALVE = Topic("/tank/valve", "std_msgs/msg/String")

FULL = Tells(
    "tells", STATE, LEVEL, lambda text, level: ("full" if level > 9 else "filling") in text, ("filling", "full")
)
FILLS = LeadsTo("fills", VALVE, LEVEL, (("open", 10.0), ("shut", 0.0)), within_s=2.0)
STAYS = replace(FILLS, pairs=(("open", 10.0),), stays_s=0.5)
STEADY = replace(STAYS, within_s=6.0, per_s=5.0)


def samples(topic: Topic, values: Sequence[object], every_s: float = 0.1, first_s: float = 0.0) -> tuple[Sample, ...]:
    times = [START + first_s + number * every_s for number in range(len(values))]
    return tuple(Sample(topic.name, topic.message(v), at, at) for v, at in zip(values, times, strict=True))


def system(
    *seen: Sequence[Sample], sent: Sequence[Sent] = (), lasts_s: float = 5.0, cpu_wait_s: float = 0.0
) -> SystemRun:
    by_topic = {found[0].topic: tuple(found) for found in seen if found}
    trace = Trace("tank_launch.py", graph=Graph(("/tank/pump",)), samples=by_topic)
    return SystemRun(trace, sent=tuple(sent), seen_from=START, seen_until=START + lasts_s, cpu_wait_s=cpu_wait_s)


def why(verdict: Verdict) -> tuple[Symptom, str]:
    assert isinstance(verdict, Failure)
    assert verdict.seen is not None
    return verdict.seen.symptom, verdict.seen.says


RATE = KeepsRate("rate", LEVEL, 10.0)


def test_a_rate_that_is_kept_to_the_end() -> None:
    assert RATE.judge(system(samples(LEVEL, [1.0] * 50))).passed


@pytest.mark.parametrize(
    ("seen", "observed", "says"),
    [
        (system(), "no message", "no message of its type comes"),
        (system(samples(LEVEL, [1.0] * 6, 1.0)), "1.00 Hz", "does not have the rate"),
        (system(samples(LEVEL, [1.0] * 20)), "none in the last 3.1 s", "stop coming"),
        (
            system((*samples(LEVEL, [1.0] * 20), *samples(LEVEL, [1.0] * 10, first_s=4.0))),
            "pause of 2.1 s",
            "stop for a while",
        ),
        (system(samples(LEVEL, [1.0] * 15, first_s=3.5)), "none in the first 3.5 s", "begin late"),
    ],
)
def test_a_rate_that_is_not_kept(seen: SystemRun, observed: str, says: str) -> None:
    verdict = RATE.judge(seen)
    assert observed in verdict.observed
    symptom, words = why(verdict)
    assert symptom is Symptom.SYSTEM_FAULT
    assert says in words


def test_what_came_before_all_nodes_were_up_is_no_pause() -> None:
    early = samples(LEVEL, [1.0], first_s=-3.0)
    assert RATE.judge(system((*early, *samples(LEVEL, [1.0] * 50)))).passed


def test_a_starved_system_has_no_rate_unless_its_messages_are_even() -> None:
    uneven = [
        Sample(LEVEL.name, {"data": 1.0}, START + at, START + at) for at in (0, 0.1, 0.9, 1.0, 1.9, 2.5, 3.3, 4.5)
    ]
    assert RATE.judge(system(uneven, cpu_wait_s=3.0)).status is Status.ERROR
    assert RATE.judge(system(uneven)).status is Status.FAILED
    assert RATE.judge(system(samples(LEVEL, [1.0] * 6, 1.0), cpu_wait_s=3.0)).status is Status.FAILED
    twice = sorted(
        [*samples(LEVEL, [1.0] * 50), *samples(LEVEL, [1.0] * 50, first_s=0.02)], key=lambda s: s.source_time
    )
    assert RATE.judge(system(twice, cpu_wait_s=3.0)).status is Status.FAILED


def orders(*at: float) -> list[Sent]:
    return [Sent(VALVE.name, value, START + after) for value, after in zip(("open", "shut"), at, strict=False)]


def test_a_value_that_leads_to_another() -> None:
    filled = samples(LEVEL, [0.0, 5.0, 10.0, 10.0, 5.0, 0.0], 0.5)
    verdict = FILLS.judge(system(filled, sent=orders(0.1, 1.2)))
    assert verdict.passed
    assert list(verdict.evidence) == ["'open': data: 10.0 after 0.9 s", "'shut': data: 0.0 after 1.3 s"]


@pytest.mark.parametrize(
    ("values", "at"),
    [
        ([0.0] * 10, (0.1,)),  # nothing happens
        ([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0], (0.1,)),  # too late
        ([0.0, 5.0, 10.0, 10.0, 10.0, 10.0], (0.1, 1.2)),  # the second one does not
        ([10.0] * 2 + [0.0] * 6, (0.6,)),  # it was there before
    ],
)
def test_a_value_that_leads_to_nothing(values: Sequence[float], at: Sequence[float]) -> None:
    symptom, says = why(FILLS.judge(system(samples(LEVEL, values, 0.5), sent=orders(*at))))
    assert symptom is Symptom.SYSTEM_FAULT
    assert "in time" in says


@pytest.mark.parametrize("after", [[10.0] * 6, [], [10.5, 10.0, 9.5, 10.0, 9.5]])
def test_a_value_that_stays(after: Sequence[float]) -> None:
    assert STAYS.judge(system(samples(LEVEL, [0.0, 5.0, 10.0, *after], 0.2), sent=orders(0.1))).passed


def test_a_value_that_only_passes() -> None:
    verdict = STAYS.judge(system(samples(LEVEL, [0.0, 5.0, 10.0, 11.0, 12.0, 13.0], 0.2), sent=orders(0.1)))
    assert "goes on to another value" in why(verdict)[1]
    assert "at the end, data: 13.0" in verdict.observed


def test_a_value_that_is_left_again_later() -> None:
    verdict = STAYS.judge(system(samples(LEVEL, [0.0, 5.0, *[10.0] * 10, 9.0, 8.0, 7.0, 6.0], 0.2), sent=orders(0.1)))
    assert "goes on to another value" in why(verdict)[1]


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ([0.0] * 4 + [0.5 * step for step in range(1, 21)] + [10.0] * 6, ""),
        ([0.0] * 4 + [0.4 * step for step in range(1, 26)] + [10.0] * 6, ""),
        ([0.0] * 4 + [0.6 * step for step in range(1, 17)] + [10.0] * 10, ""),
        ([0.0] * 4 + [0.5 * step for step in range(1, 18)] + [9.0, 9.4, 9.7, 9.9, *[10.0] * 6], ""),
        ([0.0] * 4 + [10.0] * 10, "changes by 1e+02 in a second, and not by 5"),
        ([0.0] * 4 + [1.0 * step for step in range(1, 11)] + [10.0] * 6, "changes by 10 in a second, and not by 5"),
        ([0.0] * 4 + [0.25 * step for step in range(1, 41)] + [10.0] * 6, "changes by 2.5 in a second, and not by 5"),
    ],
    ids=["right", "slower", "faster", "brakes at the end", "at once", "twice as fast", "half as fast"],
)
def test_a_value_that_must_change_steadily(values: Sequence[float], says: str) -> None:
    verdict = STEADY.judge(system(samples(LEVEL, values), sent=orders(0.35), lasts_s=0.1 * len(values)))
    if says:
        assert says in why(verdict)[1]
    else:
        assert verdict.passed


def test_rare_messages_say_nothing_of_a_pace() -> None:
    rare = samples(LEVEL, [0.0, 0.0, 4.0, 9.0, 10.0, 10.0], every_s=1.0)
    assert STEADY.judge(system(rare, sent=orders(1.1), lasts_s=6.0)).passed
    once = samples(LEVEL, [0.0, 0.0, 4.0, 10.0, 10.0], every_s=2.0)
    assert STEADY.judge(system(once, sent=orders(2.1), lasts_s=9.0)).passed


def test_a_starved_system_is_not_slow_but_may_be_too_fast() -> None:
    slow = samples(LEVEL, [0.0] * 4 + [0.25 * step for step in range(1, 41)] + [10.0] * 6)
    assert STEADY.judge(system(slow, sent=orders(0.35), cpu_wait_s=3.0)).status is Status.ERROR
    at_once = samples(LEVEL, [0.0] * 4 + [10.0] * 10)
    assert STEADY.judge(system(at_once, sent=orders(0.35), cpu_wait_s=3.0)).status is Status.FAILED


def test_a_starved_system_that_does_something_is_not_late() -> None:
    slow = samples(LEVEL, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], 0.5)
    assert FILLS.judge(system(slow, sent=orders(0.1), cpu_wait_s=3.0)).status is Status.ERROR
    still = samples(LEVEL, [0.0] * 6, 0.5)
    assert FILLS.judge(system(still, sent=orders(0.1), cpu_wait_s=3.0)).status is Status.FAILED


LEVELS = samples(LEVEL, [float(level) for level in range(13)], 0.5)


def told(*texts: str) -> tuple[Sample, ...]:
    return samples(STATE, texts, 1.0, first_s=0.2)


def test_texts_that_agree_may_be_a_little_late() -> None:
    verdict = FULL.judge(system(LEVELS, told("", "filling", "filling", "filling", "filling", "filling", "full")))
    assert verdict.passed


@pytest.mark.parametrize(
    ("texts", "says"),
    [
        (("unknown",) * 6, "something else than"),
        (("full",) * 6, "something else than"),
        (("filling",) * 7, "something else than"),  # when the level has long been above
        (("filling",) * 4, "never says 'full'"),
        ((), "no message"),
    ],
)
def test_texts_that_do_not_agree(texts: Sequence[str], says: str) -> None:
    levels = [*LEVELS[:10], *samples(LEVEL, [12.0] * 6, 0.4, first_s=4.5)]
    assert says in why(FULL.judge(system(levels, told(*texts))))[1]


def test_a_late_text_of_a_starved_system_is_not_wrong() -> None:
    levels = [*samples(LEVEL, [1.0], first_s=0.0), *samples(LEVEL, [12.0] * 20, 0.25, first_s=0.3)]
    late = told("filling", "filling", "filling", "filling", "full")
    assert FULL.judge(system(levels, late, cpu_wait_s=3.0)).status is Status.ERROR
    assert FULL.judge(system(levels, late)).status is Status.FAILED


PUMP = TopicEndpoint("/tank/level", LEVEL.type, "/tank/pump", QoS("best_effort"))
AGREED = Endpoint("/tank/pump", "/tank/level", LEVEL.type, "best_effort", "volatile")


@pytest.mark.parametrize(
    ("change", "difference"),
    [
        (lambda pump: pump, ""),
        (lambda pump: replace(pump, node="/pump"), "is not there; /pump has one"),
        (lambda pump: replace(pump, topic="/level"), "is not there"),
        (lambda pump: replace(pump, type="std_msgs/msg/Int32"), "has the type std_msgs/msg/Int32"),
        (lambda pump: replace(pump, qos=QoS("reliable")), "is reliable"),
        (lambda pump: replace(pump, qos=QoS("best_effort", "transient_local")), "is transient local"),
    ],
)
def test_endpoints_are_as_agreed_on(change: Callable[[TopicEndpoint], TopicEndpoint], difference: str) -> None:
    found = Graph(("/tank/pump",), publishers=(change(PUMP), replace(PUMP, topic="/tank/more")))
    run = system()
    verdict = HasEndpoints("agreed", (AGREED,)).judge(replace(run, trace=replace(run.trace, graph=found)))
    assert verdict.passed == (not difference)
    if difference:
        assert verdict.observed == f"the publisher of /tank/pump on /tank/level {difference}"
        assert why(verdict)[0] is Symptom.SYSTEM_CHANGED


def test_a_launch_that_has_lost_a_process_is_said_to_be_broken() -> None:
    died = OutputLine("stderr", "[ERROR] [pump-1]: process has died [pid 9, exit code 1, cmd 'pump'].", START)
    run = system()
    broken = replace(run, trace=replace(run.trace, output=(died,)))
    assert why(RATE.judge(broken))[0] is Symptom.NOT_LAUNCHED
