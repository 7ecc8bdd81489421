"""The form for messages of given publishers, judged on made-up facts: a gate, a microphone and a doorbell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from tests.checks.builders import NO_NODE, assert_failed, assert_passed, ending, graph, judge_of, log, trace
from tutor.exercise import EndsCleanly, GivenPublisher, Program, QoS, ShowsEach, Topic, check
from tutor.exercise.given_system import Heard, SystemSeen
from tutor.judge.trace import Trace
from tutor.judge.verdict import Verdict
from tutor.ros_model import TopicEndpoint

STRING = "std_msgs/msg/String"
GATE = GivenPublisher(Topic("/gate", STRING), lambda: ["open"], "before", QoS(durability="transient_local"))
SOUND = GivenPublisher(Topic("/sound", STRING), lambda: ["la", "lu"], offers=QoS(reliability="best_effort"))
RINGS = GivenPublisher(Topic("/rings", STRING), lambda: [f"ring {number:02}" for number in range(60)], "at once")

CHECK = check(
    "t1", Program("node.py"), ShowsEach("gate", GATE), ShowsEach("sound", SOUND), ShowsEach("rings", RINGS),
    EndsCleanly("end", bonus=True),
)  # fmt: skip
ALL_LOGGED = tuple((f"[INFO] [node]: {value}",) for value in RINGS.values())

IN_PAIRS = tuple((f"[INFO] [node]: ring {number // 2 * 2:02}, ring {number // 2 * 2 + 1:02}",) for number in range(60))


def heard(given: GivenPublisher, *shown: Sequence[str], matched: bool = True) -> Heard:
    """What became of all messages of a publisher: for each, the log messages that show it; in none, if not given."""
    sent = tuple(given.values())
    found = tuple(map(tuple, shown)) + ((),) * (len(sent) - len(shown))
    topic = given.topic
    return Heard(TopicEndpoint(topic.name, topic.type, "/given", given.offers), matched, sent, found)


def run(given: GivenPublisher, *requested: QoS, **more: Any) -> Trace:
    """A run in which the node has a subscription on a publisher's topic for each QoS."""
    ends = tuple(TopicEndpoint(given.topic.name, STRING, "/node", qos) for qos in requested)
    return trace(graph=replace(graph(), subscriptions=ends), **more)


def judge(part: Heard, seen: Trace) -> Verdict:
    """The verdict on what became of one publisher's messages."""
    criterion = part.ours.topic.strip("/")
    return judge_of(CHECK, criterion)(SystemSeen(seen, heard=(part,), ending=ending(0)))


LATCHED = QoS(durability="transient_local")
LOSSY = QoS(reliability="best_effort")
LOSES = "best effort where each message counts"


def test_all_publishers_are_one_system_which_is_also_judged_by_its_end() -> None:
    assert len({scenario for criterion in CHECK.criteria for scenario in criterion.facts}) == 1


@pytest.mark.parametrize(
    ("part", "seen"),
    [
        (heard(GATE, ["the gate is open"]), run(GATE, LATCHED)),
        (heard(GATE, ["the gate is open"]), run(GATE)),  # a subscription that is given up once it has got it
        (heard(SOUND, ["la"], ["lu"]), run(SOUND, LOSSY)),
        (heard(RINGS, *ALL_LOGGED), run(RINGS, QoS())),
        (heard(RINGS, *ALL_LOGGED), run(RINGS, LOSSY, QoS())),
    ],
)
def test_each_message_in_one_log_message_passes(part: Heard, seen: Trace) -> None:
    assert_passed(judge(part, seen))


@pytest.mark.parametrize(
    ("part", "seen", "mistake", "words"),
    [
        (heard(GATE), run(GATE, QoS()), "late subscriber", "keeps it for those who come later"),
        (heard(GATE), run(GATE, LOSSY), "late subscriber", "/gate"),
        (heard(GATE, ["open"]), run(GATE, QoS("best_effort", "transient_local")), LOSES, "never sent"),
        (heard(GATE), run(GATE, QoS("best_effort", "transient_local")), LOSES, "/gate"),
        (heard(GATE), run(GATE, LATCHED), "not logged", "open was published on /gate"),
        (heard(GATE), run(GATE, LATCHED, out="open"), "printed, not logged", "what arrives on /gate"),
        (heard(GATE, matched=False), run(GATE), "no subscription", "/gate"),
        (heard(GATE, matched=False), NO_NODE, "no node", ""),
        (heard(SOUND, matched=False), run(SOUND, QoS()), "incompatible QoS", "offers reliability best_effort"),
        (heard(SOUND, ["la"]), run(SOUND, LOSSY), "not logged", "lu"),
        (heard(SOUND, (), ["lu"]), run(SOUND, LOSSY), "messages lost", "1 of 2"),
        (heard(SOUND, ["la", "la"], ["lu", "lu"]), run(SOUND, LOSSY, LOSSY), "subscribed twice", "2 subscriptions"),
        (heard(SOUND, ["la", "la"], ["lu"]), run(SOUND, QoS(), LOSSY), "shown again", "1 message of 2"),
        (
            heard(RINGS, *[()] * 49, *ALL_LOGGED[49:]),
            run(RINGS, QoS()),
            "queue shorter than a burst",
            "11 were handled",
        ),
        (heard(RINGS, *ALL_LOGGED[:5]), run(RINGS, QoS()), "messages lost", "5 of 60"),
        (heard(RINGS, *[()] * 59, *ALL_LOGGED[59:]), run(RINGS, QoS()), "messages lost", "1 of 60"),
        (
            heard(RINGS, *IN_PAIRS),
            run(RINGS, QoS()),
            "shown together",
            "60 of 60 messages in a log message with others",
        ),
        (heard(RINGS, *ALL_LOGGED[:58], *IN_PAIRS[58:]), run(RINGS, QoS()), "shown together", "2 of 60"),
        (heard(RINGS, *IN_PAIRS[:58]), run(RINGS, QoS()), "shown together", "58 of 60"),  # a cut-off log message, say
        (heard(RINGS, *IN_PAIRS), run(RINGS, LOSSY), "shown together", "60 of 60"),
        (heard(SOUND, ["la", "lu after la"], ["lu after la"]), run(SOUND, LOSSY), "shown again", "1 message of 2"),
        (heard(RINGS, *ALL_LOGGED), run(RINGS, LOSSY), LOSES, "by luck"),
        (heard(RINGS, *[()] * 49, *ALL_LOGGED[49:]), run(RINGS, LOSSY), LOSES, "11 in the log"),
        (heard(RINGS, matched=False), run(RINGS, LATCHED), "incompatible QoS", "transient_local"),
    ],
)
def test_what_is_missing_or_comes_twice_is_said_by_its_mistake(
    part: Heard, seen: Trace, mistake: str, words: str
) -> None:
    assert_failed(judge(part, seen), mistake, words, check=CHECK)


def test_both_ends_are_shown_as_ros2_topic_info_does_with_the_warning_of_rclpy() -> None:
    warning = log("New publisher discovered on topic 'sound', offering incompatible QoS.", 30)
    other = log("New publisher discovered on topic '/soundtrack', offering incompatible QoS.", 30)
    failure = judge(heard(SOUND, matched=False), run(SOUND, QoS(), logs=[other, warning]))
    assert tuple(failure.evidence) == (
        "offered on /sound: Reliability: BEST_EFFORT, Durability: VOLATILE",
        "requested by /node: Reliability: RELIABLE, Durability: VOLATILE",
        str(warning),
    )


def test_where_a_message_is_missing_what_the_node_logged_instead_is_shown() -> None:
    warning = log("New publisher discovered on topic 'sound', offering incompatible QoS.", 30)
    logged = (str(warning), "[INFO] [node]: sound no. 1")
    part = replace(heard(SOUND), last_logged=logged)
    failure = judge(part, run(SOUND, LOSSY, logs=[warning]))
    assert tuple(failure.evidence)[2:] == (str(warning), "[INFO] [node]: sound no. 1")


def test_lost_messages_lead_to_the_queue_as_well_as_to_the_log() -> None:
    failure = judge(heard(SOUND, (), ["lu"]), run(SOUND, LOSSY))
    assert_failed(failure, "messages lost", "how many messages may wait", "on the way from there", check=CHECK)


def test_an_authors_mistake_is_said_in_one_sentence() -> None:
    with pytest.raises(ValueError, match="'twice' is no way to send: take before, one by one, at once"):
        replace(SOUND, sends="twice")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="/rings: what is sent before the node starts must be kept"):
        replace(RINGS, sends="before")
    with pytest.raises(ValueError, match="/rings: only what is sent one by one may have a pace"):
        replace(RINGS, every_s=0.2)
