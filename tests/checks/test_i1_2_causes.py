"""I1.2: why a node fails, as its source or its end shows."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from checks.i1_2_message_statistics.count import in_words
from checks.i1_2_message_statistics.gaps import judge_jumps
from checks.i1_2_message_statistics.logged_summaries import find_summaries
from checks.i1_2_message_statistics.plans import JUMP_AFTER, RESTART_AFTER
from tests.checks import statistics_nodes as nodes
from tests.checks.builders import CRASH, FOLDER, NO_NODE, NODE_UP, assert_skipped, exited, trace
from tests.checks.statistics_nodes import ONE_TOO_MANY, RIGHT, Make, node, restarting, silent_about_gaps
from tests.checks.statistics_trials import (
    LISTENING,
    Trials,
    assert_failed,
    judge_trials,
    observe,
    restart,
    slowly,
    with_trace,
)
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Status
from tutor.ros_model import TopicEndpoint

SUMMARY = "10 from Hello World: 0 to Hello World: 9"
ELSEWHERE = replace(NODE_UP, subscriptions=(TopicEndpoint("/chatters", "std_msgs/msg/String", "/node"),))
WAITS = node(due=lambda node: False, heard="waiting for the publisher")
STUCK = (
    Frame(f"{FOLDER}/stats.py", 12, "wait", "time.sleep(1)"),
    Frame(f"{FOLDER}/stats.py", 20, "<module>", "main()"),
)


@pytest.mark.parametrize(
    ("seen", "facts", "cause", "words"),
    [
        (trace(graph=LISTENING), {}, "no summary", ""),
        (trace(graph=LISTENING), {"spins": False}, "no spin", ""),
        (slowly(WAITS).steady.trace, {"spins": False, "stuck": STUCK}, "no spin", "line 12"),
        (NO_NODE, {"sent": ()}, "no node", ""),
        (trace(), {"sent": ()}, "no subscription", ""),
        (trace(graph=LISTENING, out=SUMMARY), {}, "printed, not logged", ""),
        (trace(graph=LISTENING, err=CRASH, exit=exited(1)), {}, "unhandled exception", "line 12"),
        (trace(graph=LISTENING, err=f"[INFO] [17.1] [stats]: {SUMMARY}"), {}, "not the node's logger", ""),
        (trace(graph=ELSEWHERE), {"sent": ()}, "wrong topic", ""),
    ],
)
def test_causes_of_no_summary(seen: Trace, facts: dict[str, Any], cause: str, words: str) -> None:
    trial = replace(slowly(RIGHT).steady, trace=seen, **facts)
    assert_failed(Trials(trial, trial).judge("summary"), cause, words)


@pytest.mark.parametrize("criterion", ["count", "rate", "restart", "gaps"])
def test_without_a_summary_the_other_criteria_are_skipped(criterion: str) -> None:
    nothing = replace(slowly(RIGHT).steady, trace=trace(graph=LISTENING))
    assert_skipped(Trials(nothing, nothing, nothing, restart=restart(RIGHT())).judge(criterion), "not judged")


def test_a_node_that_exits_on_a_restart_or_a_jump_fails() -> None:
    trials, restarted = slowly(RIGHT), restart(RIGHT())
    ended = with_trace(restarted, exit=exited(0, after_s=4))
    assert_failed(replace(trials, restart=ended).judge("restart"), "exit at once")
    deaf = replace(restarted, sent=restarted.sent[:RESTART_AFTER], trace=trace(logs=restarted.trace.logs))
    assert_failed(replace(trials, restart=deaf).judge("restart"), "no subscription")
    assert find_summaries(replace(deaf, trace=restarted.trace))[0].messages == 10
    crashed = trace(graph=LISTENING, logs=trials.jump.trace.logs, err=CRASH, exit=exited(1))
    assert_failed(judge_jumps(replace(trials.jump, trace=crashed), trials.steady), "unhandled exception")
    twice = trials.jump_twice
    early = replace(twice, sent=twice.sent[:JUMP_AFTER], trace=replace(crashed, logs=twice.trace.logs[:1]))
    assert_failed(replace(trials, jump_twice=early).judge("gaps"), "unhandled exception")


TWO_SUBSCRIPTIONS = """
self.one = self.create_subscription(String, 'chatter', self.heard, 10)

self.other = self.create_subscription(String, 'chatter', self.heard, 10)
"""


def test_two_subscriptions_are_the_cause_of_every_failure() -> None:
    verdicts = judge_trials(node(nodes.SubscribedTwice), TWO_SUBSCRIPTIONS, 2).values()
    failures = [verdict for verdict in verdicts if verdict.status is Status.FAILED]
    assert len(failures) >= 2
    for verdict in failures:
        assert_failed(verdict, "two subscriptions", "lines 2 and 4")


@pytest.mark.parametrize(
    ("make", "subscriptions"),
    [(node(nodes.SubscribedTwice), 1), (ONE_TOO_MANY, 2)],
    ids=["there is only one", "messages count once"],
)
def test_two_subscriptions_are_blamed_only_if_they_exist_and_messages_count_twice(
    make: Make, subscriptions: int
) -> None:
    for verdict in judge_trials(make, TWO_SUBSCRIPTIONS, subscriptions).values():
        assert "two subscriptions" not in verdict.cause


OWN_PUBLISHER = """\
class Stats(Node):
    def __init__(self):
        self.sub = self.create_subscription(String, 'chatter', self.heard, 10)
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.log = self.create_publisher(String, 'log', 10)
    def heard(self, message):
        self.log.publish(message)
    def tick(self):
        self.pub.publish(String())
"""


@pytest.mark.parametrize(("topic", "blamed"), [("/chatter", True), ("/log", False)])
def test_a_node_that_publishes_on_the_topic_counts_its_own_messages(topic: str, blamed: bool) -> None:
    network = replace(LISTENING, publishers=(TopicEndpoint(topic, "std_msgs/msg/String", "/node"),))
    trials = vars(observe(ONE_TOO_MANY)).values()
    verdict = Trials(*(with_trace(t, graph=network, sources={"node.py": OWN_PUBLISHER}) for t in trials)).judge("count")
    assert verdict.status is Status.FAILED
    assert verdict.cause.startswith("own messages") == blamed


@pytest.mark.parametrize(
    ("code", "cause"), [("x = text[:12]", "content cut off"), ("x = text[-3:]", "first message missing")]
)
def test_a_slice_explains_a_content_without_its_number(code: str, cause: str) -> None:
    trials = slowly(node(summary="count={count} rate={rate:.2f} first={first:.12} last={last:.12}"))
    trials = replace(trials, steady=with_trace(trials.steady, sources={"message_stats.py": code}))
    assert_failed(trials.judge("summary"), cause)


HEARD = """\
class Stats(Node):
    def __init__(self):
        self.count, self.last = 0, None
        self.create_subscription(String, 'chatter', self.heard, 10)
    def heard(self, message):
        number = int(message.data.split(':')[1])
"""
COMPARED = f"{HEARD}        if number != self.last + 1: self.alarm()\n"


@pytest.mark.parametrize(
    ("make", "source", "cause"),
    [
        (nodes.GAP_BLIND, HEARD.replace(".split(':')[1]", "[-1]"), "number misread"),
        (
            nodes.GAP_BLIND,
            f"{HEARD}        self.count += 1\n        if number != self.count: self.alarm()",
            "number compared with the count",
        ),
        (node(nodes.WarnsForEverAfterAGap), f"{COMPARED}        else: self.last = number", "last number out of date"),
        (
            nodes.GAP_BLIND,
            f"{HEARD}        self.last = number\n        if number != self.last: self.alarm()",
            "last number set too early",
        ),
        (
            silent_about_gaps(fall="sequence went back"),
            f"{HEARD}        if number < self.last: self.alarm()\n        self.last = number",
            "only lower numbers",
        ),
        (nodes.GAP_BLIND, f"{COMPARED}        self.last = number", "gap not noticed"),
    ],
)
def test_the_source_shows_why_gaps_are_reported_wrongly(make: Make, source: str, cause: str) -> None:
    assert_failed(judge_trials(make, source)["gaps"], cause)


def test_the_test_that_zero_does_not_pass_is_named() -> None:
    source = (
        "def heard(msg):\n    global last_number\n    n = int(msg.data.split(':')[1])\n"
        "    if last_number and n != last_number + 1:\n        node.get_logger().warning('gap')\n    last_number = n\n"
        "node.create_subscription(String, 'chatter', heard, 10)\n"
    )
    verdict = judge_trials(nodes.BLIND_AFTER_ZERO, source)["gaps"]
    assert "line 4: last_number counts as false when it is 0" in verdict.cause


def test_a_comparison_of_texts_explains_a_silent_reset() -> None:
    source = f"{HEARD}        if message.data < self.last: self.count = 0\n        self.last = message.data\n"
    assert_failed(judge_trials(restarting(()), source)["restart"], "texts compared", "line 7")


@pytest.mark.parametrize(
    ("totals", "words"), [(range(30, 31), "30"), (range(30, 32), "30 or 31"), (range(50, 60), "50 to 59")]
)
def test_possible_totals_in_words(totals: range, words: str) -> None:
    assert in_words(totals) == words
