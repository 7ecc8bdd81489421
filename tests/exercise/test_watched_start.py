"""Forms that watch a start or send messages, judged on made-up facts: a robot with a battery."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import pytest

from tests.checks.builders import (
    NO_NODE,
    START,
    assert_failed,
    assert_passed,
    assert_undecided,
    early_judge_of,
    ending,
    graph,
    judge_of,
    log,
    sample,
    samples,
    trace,
)
from tutor.exercise import AtLeast, EndsCleanly, FieldEquals, Form, LogsText, Program, Receives, Stamped, Topic, check
from tutor.exercise.collected_values import find_out_of_range
from tutor.exercise.nouns import agrees
from tutor.exercise.receives import Reception, says
from tutor.exercise.seen_run import Seen
from tutor.exercise.watched_start import WatchedStart
from tutor.judge.check import Check
from tutor.judge.trace import Sample, Trace
from tutor.judge.verdict import Verdict
from tutor.ros_model import TopicEndpoint

ROBOT = Program("robot.py")
BATTERY = Topic("/battery", "std_msgs/msg/Float32")
COMMAND = Topic("/command", "geometry_msgs/msg/Twist", "linear.x")
OURS = TopicEndpoint(COMMAND.name, COMMAND.type, "/ours")
FULL = trace(
    *samples(BATTERY.name, 10.0, data=0.8999999761581421), graph=graph(publishers={BATTERY.name: BATTERY.type})
)


def judged(form: Form, seen: Seen | Trace) -> tuple[Verdict, Check]:
    """The verdict on what a form saw in the only start."""
    made = check("t1", ROBOT, form)
    seen = Seen(seen) if isinstance(seen, Trace) else seen
    return judge_of(made, form.id)(WatchedStart((seen,), seen.trace, ending(0))), made


def test_all_that_only_watches_shares_one_start_also_with_the_end() -> None:
    ready = LogsText("ready", "ready")
    forms = (ready, AtLeast("often", BATTERY, 3, after=ready), FieldEquals("full", BATTERY, [1.0]), EndsCleanly("end"))
    made = check("t1", ROBOT, *forms)
    assert len({scenario for criterion in made.criteria for scenario in criterion.facts}) == 1


def test_each_is_judged_on_what_it_saw_itself_and_fails_early_only_where_the_machine_was_not_slow() -> None:
    made = check("t1", ROBOT, LogsText("ready", "ready"), LogsText("go", "go"))
    early, seen = early_judge_of(made, "go"), Seen(trace(logs=[log("ready")]))
    assert early(WatchedStart((seen, None), seen.trace)) is None
    assert early(WatchedStart((None, replace(seen, slowed=True)), seen.trace)) is None
    assert early(WatchedStart((None, Seen(trace(logs=[log("go")]))), seen.trace)) is None
    assert_failed(early(WatchedStart((None, seen), seen.trace)), "not logged", "'go'", check=made)
    assert WatchedStart((None, replace(seen, slowed=True)), seen.trace).slowed


@pytest.mark.parametrize(
    ("form", "text", "level", "words"),
    [
        (LogsText("log", "robot READY"), "Robot ready.", 20, ""),
        (LogsText("log", re.compile(r"at \d+")), "battery at 90", 20, ""),
        (LogsText("log", "low", severity="warn"), "battery low", 40, ""),
        (LogsText("log", "low", severity="warn"), "battery low", 20, "not at WARN or above"),
        (LogsText("log", "ready"), "up", 20, "in none of 1 log message"),
        (LogsText("log", re.compile("Ready")), "ready", 20, "no log message contains 'Ready'"),
    ],
)
def test_a_text_is_logged(form: LogsText, text: str, level: int, words: str) -> None:
    verdict, made = judged(form, trace(logs=[log(text, level)]))
    if words:
        assert_failed(verdict, "not logged", words, check=made)
    else:
        assert_passed(verdict)


def test_messages_count_from_the_first_one_on() -> None:
    often = AtLeast("often", BATTERY, 10, within_s=1.0)
    assert_passed(judged(often, FULL)[0])
    slow = trace(*samples(BATTERY.name, 8.0), graph=FULL.graph)
    verdict, made = judged(often, slow)
    assert_failed(verdict, "no messages", "9 messages in 1.0 s", check=made)
    assert_passed(judged(often, Seen(slow, cpu_wait_s=0.2))[0])
    assert_failed(judged(often, NO_NODE)[0], "no node", "no such message", check=made)


@pytest.mark.parametrize(
    ("form", "words"),
    [
        (FieldEquals("full", BATTERY, 0.9), ""),
        (FieldEquals("full", BATTERY, 0.9, every=True), ""),
        (FieldEquals("full", BATTERY, lambda value: value < 1, what="below 1", every=True), ""),
        (FieldEquals("full", BATTERY, 0.91), "in none of 10 messages"),
        (FieldEquals("full", BATTERY, lambda value: value > 1, what="above 1", every=True), "not above 1"),
        (FieldEquals("full", BATTERY, 1.0, says="it is empty", do="Charge."), "it is empty"),
    ],
)
def test_a_field_equals(form: FieldEquals, words: str) -> None:
    verdict, made = judged(form, FULL)
    if words:
        assert_failed(verdict, "wrong values", words, check=made)
    else:
        assert_passed(verdict)


def test_the_bits_of_an_int_are_no_value() -> None:
    """What arrives of an int in a float field is in the range only by chance, and in no message is it right."""
    ints = trace(*(sample(BATTERY.name, 4e-323, 1001.0 + n / 10) for n in range(10)), graph=FULL.graph)
    for every in (True, False):
        form = FieldEquals("any", BATTERY, lambda value: value < 1, what="below 1", every=every)
        verdict, made = judged(form, ints)
        assert_failed(verdict, "an int in a float field", check=made)
    assert find_out_of_range([4e-323, 0.0, 0.5], Topic("/x", "y/msg/Z", low=0.0, high=1.0)) == [4e-323]


def test_one_message_decides() -> None:
    mixed = trace(*(sample(BATTERY.name, value, 1001.0) for value in (0.9, 0.9, 0.5)), graph=FULL.graph)
    assert_passed(judged(FieldEquals("any", BATTERY, 0.5), mixed)[0])
    verdict, made = judged(FieldEquals("every", BATTERY, 0.9, every=True), mixed)
    assert_failed(verdict, "wrong values", "0.5", check=made)


SCAN = Topic("/scan", "sensor_msgs/msg/LaserScan", "header.stamp")


def stamped(*stamps: float) -> Trace:
    """Messages that are sent every half second, from START on, with these stamps."""
    return trace(
        *(
            Sample(SCAN.name, {"header": {"stamp": {"sec": int(at), "nanosec": round(at % 1 * 1e9)}}}, sent, sent)
            for at, sent in ((at, START + number / 2) for number, at in enumerate(stamps))
        ),
        graph=graph(publishers={SCAN.name: SCAN.type}),
    )


@pytest.mark.parametrize(
    ("stamps", "words"),
    [
        ([START, START + 0.49, START + 0.8], ""),
        ([START, START, START + 1.0], ""),
        ([START, START, START], "header.stamp is not the time of now, but 1.0 s before the message is sent"),
        ([START, START + 2.0], "but 1.5 s after the message is sent"),
        ([START - 0.6], "but 0.6 s before the message is sent"),
        ([0.0], "header.stamp is not the time of now"),
    ],
)
def test_a_stamp_is_the_time_of_now_in_every_message(stamps: list[float], words: str) -> None:
    verdict, made = judged(Stamped("stamped", SCAN), stamped(*stamps))
    if words:
        assert_failed(verdict, "wrong values", words, check=made)
    else:
        assert_passed(verdict)


def test_a_busy_machine_may_be_to_blame_for_an_old_stamp() -> None:
    old = stamped(START - 0.6)
    assert_undecided(judged(Stamped("stamped", SCAN), Seen(old, cpu_wait_s=0.2))[0])
    verdict, made = judged(Stamped("stamped", SCAN), Seen(old, cpu_wait_s=0.05))
    assert_failed(verdict, "wrong values", "but 0.6 s before", check=made)
    several = stamped(START, START, START - 0.1, START - 0.2)
    verdict, made = judged(Stamped("stamped", SCAN), Seen(several, cpu_wait_s=2.0))
    assert_failed(verdict, "wrong values", "but 1.7 s before", check=made)
    early = stamped(START + 0.6)
    verdict, made = judged(Stamped("stamped", SCAN), Seen(early, cpu_wait_s=2.0))
    assert_failed(verdict, "wrong values", "but 0.6 s after", check=made)


@pytest.mark.parametrize(
    ("value", "wanted", "is_it"),
    [
        (0.30000001192092896, 0.3, True),
        (0.31, 0.3, False),
        (3, 3.0, True),
        ([0, 1, 1], (0, 1, 1), True),
        ([0, 1], [0, 1, 1], False),
        ({"x": 1.0, "y": 2.0}, {"x": 1.0}, True),
        ({"x": 1.0}, {"z": 1.0}, False),
        ("ready", "read", False),
    ],
)
def test_a_value_agrees(value: object, wanted: object, is_it: bool) -> None:
    assert agrees(value, wanted) is is_it


@pytest.mark.parametrize(
    ("text", "wanted", "is_it"),
    [
        ("heard LEFT", "left", True),
        ("speed 1.50 m/s", 1.5, True),
        ("speed 1.5.", 1.5, True),
        ("speed 11.5", 1.5, False),
        ("count 13", 3, False),
        ("count: 3,", 3, True),
        ("-3", 3, False),
        ("on: True", True, True),
    ],
)
def test_a_log_message_says_a_value(text: str, wanted: object, is_it: bool) -> None:
    assert says(text, wanted) is is_it


def test_what_is_sent_is_shown() -> None:
    made = check("t1", ROBOT, Receives("hears", COMMAND, (1.5, 2.5), becomes=lambda value: 2 * value))
    listens = replace(graph(), subscriptions=(TopicEndpoint(COMMAND.name, COMMAND.type, "/node"),))
    judge, up = judge_of(made, "hears"), trace(logs=[log("3.0")], graph=listens)
    assert_passed(judge(Reception(up, shown=("3.0", "5.0"), ours=OURS)))
    assert_failed(judge(Reception(up, shown=("3.0",), ours=OURS)), "nothing received", "2.5", "5.0", check=made)
    assert_failed(judge(Reception(trace(), subscribed=False, ours=OURS)), "no subscription", "/command", check=made)
    assert_failed(judge(Reception(NO_NODE, subscribed=False, ours=OURS)), "no node", check=made)
    assert COMMAND.message(1.5) == {"linear": {"x": 1.5}}


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda: LogsText("log", "ready", severity="loud"), "'loud' is no severity: take one of debug, info, warn"),
        (lambda: FieldEquals("full", BATTERY, lambda value: value < 1), "say in words what the value must be"),
    ],
)
def test_an_authors_mistake_is_said_in_one_sentence(made: Callable[[], object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        made()
