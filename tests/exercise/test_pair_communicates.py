"""Whether a subscriber gets what a publisher sends, on fabricated launches."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.checks.builders import START, assert_passed
from tests.exercise.launches import (
    DEAD,
    DEFAULT_RUN,
    LISTENER,
    TALKER,
    assert_failed,
    endpoint,
    graph,
    judge_communicates,
    launched,
    log_record,
    pair,
)
from tutor.exercise.launch_graph import pairs
from tutor.exercise.quoted_messages import logs_of_messages
from tutor.judge.trace import Sample
from tutor.ros_model import TopicEndpoint


def test_a_logged_message_is_evidence() -> None:
    seen = launched(pair("/chatter"), logs=(log_record("I heard: [Hello World: 1]"),))
    verdict = judge_communicates(seen)
    assert_passed(verdict)
    assert any("I heard" in line for line in verdict.evidence)


def test_a_subscriber_that_logs_nothing_passes_if_it_spins() -> None:
    assert_passed(judge_communicates(DEFAULT_RUN))
    assert_failed(
        judge_communicates(launched(pair("/chatter"), answering=frozenset({TALKER}))), "not connected", LISTENER
    )


def test_a_subscriber_that_answers_no_calls_passes_if_it_logs() -> None:
    seen = launched(pair("/chatter"), answering=frozenset(), logs=(log_record("Hello World: 0"),))
    assert_passed(judge_communicates(seen))


@pytest.mark.parametrize(
    ("logged", "proves"),
    [
        (("got 0", "got 1"), True),
        (("got 0", "still 0"), False),  # any message may contain a number
        (("waiting 1.0 s",), False),
        (("10 and 11",), False),
    ],
)
def test_which_logged_numbers_prove_communication(logged: Sequence[str], proves: bool) -> None:
    samples = [Sample("/chatter", {"data": number}, START + number / 10, START) for number in range(2)]
    found = logs_of_messages(pairs(pair("/chatter"))[0], [log_record(text) for text in logged], samples)
    assert bool(found) == proves


@pytest.mark.parametrize(
    ("said", "proves"), [("HELLO WORLD: 1!", True), ("Hello World: 11", False), ("Hello World: 1.", True)]
)
def test_which_logged_texts_prove_communication(said: str, proves: bool) -> None:
    samples = [Sample("/chatter", {"data": "Hello World: 1"}, START, START)]
    assert bool(logs_of_messages(pairs(pair("/chatter"))[0], [log_record(said)], samples)) == proves


def test_a_log_of_another_node_is_no_proof() -> None:
    seen = launched(pair("/chatter"), answering=frozenset(), logs=(log_record("Hello World: 0", "talker"),))
    assert_failed(judge_communicates(seen), "not connected")


@pytest.mark.parametrize(
    ("publisher", "subscription", "cause"),
    [
        (endpoint("/chatter", TALKER, reliability="best_effort"), endpoint("/chatter", LISTENER), "incompatible QoS"),
        (
            endpoint("/chatter", TALKER),
            endpoint("/chatter", LISTENER, durability="transient_local"),
            "incompatible QoS",
        ),
        (endpoint("/chatter", TALKER), endpoint("/chatter", LISTENER, type="std_msgs/msg/Int32"), "not connected"),
        (endpoint("/chatter", TALKER), endpoint("/chater", LISTENER), "wrong topic"),
    ],
)
def test_causes_of_messages_that_do_not_arrive(
    publisher: TopicEndpoint, subscription: TopicEndpoint, cause: str
) -> None:
    seen = launched(graph([publisher], [subscription]), logs=(log_record("I heard: [Hello World: 1]"),))
    assert_failed(judge_communicates(seen), cause)


def test_one_connected_pair_is_enough() -> None:
    deaf = endpoint("/chatter", "/deaf", durability="transient_local")
    assert_passed(
        judge_communicates(launched(graph([endpoint("/chatter", TALKER)], [deaf, endpoint("/chatter", LISTENER)])))
    )


def test_no_messages_at_all() -> None:
    assert_failed(judge_communicates(launched(pair("/chatter"), messages=0)), "not connected", TALKER)


def test_a_subscriber_that_a_message_crashed() -> None:
    seen = launched(pair("/chatter"), out=DEAD, disconnected=True)
    assert_failed(judge_communicates(seen), "unhandled exception", "hearer.py, line 7")


def test_a_message_must_be_sent_before_its_log_to_be_proof() -> None:
    sample = Sample("/chatter", {"data": "late"}, START + 9, START + 9)
    seen = pairs(pair("/chatter"))[0]
    assert logs_of_messages(seen, [log_record("late")], [sample]) == []
