"""I1.2: summaries that are missing, or too many."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from checks.i1_2_message_statistics.mistakes.entries import CATALOGUE, shown, told
from tutor.judge.symptom import Symptom
from tutor.mistakes import Case, Found, found
from tutor.mistakes.examples import in_run

_EVERY = "Look at the condition for a summary: it should hold once for every tenth message, whenever that comes."


@shown(
    "summary-for-every-message",
    says="there were {summaries} summaries for {messages} messages",
    do=_EVERY,
    summaries=20,
    messages=20,
)
def every_message(case: Case) -> Iterator[Found]:
    """Something that is meant for every so many messages is done for each one.

    A callback runs for each message. What is meant for every hundredth needs a condition on the count that holds once
    in a hundred.

    Bad:

        if self.visitors >= 100:
            self.ring()

    Good:

        if self.visitors % 100 == 0:
            self.ring()

    See it: the log beside the messages.
    """
    return told(case, "summary-for-every-message")


@shown(
    "too-many-summaries",
    says="there were {summaries} summaries for {messages} messages",
    do=_EVERY,
    summaries=4,
    messages=20,
)
def too_many(case: Case) -> Iterator[Found]:
    """Something is done more often than asked for.

    A timer knows nothing about the messages, and may find the same count several times. A condition that is checked in
    two places is met twice.

    Bad:

        self.create_timer(1.0, self.ring_if_full)

    Good:

        self.visitors += 1
        self.ring_if_full()

    See it: the time stamps in the log.
    """
    return told(case, "too-many-summaries")


@shown("missing-summary", says="{what}", do=_EVERY, what="there is none after 10 messages, and none comes soon after")
def missing(case: Case) -> Iterator[Found]:
    """A summary does not come when it is due.

    A condition that holds only once, or on a count that other code changes as well, is not met when it should be.

    Bad:

        if self.visitors == 100:
            self.ring()

    Good:

        if self.visitors % 100 == 0:
            self.ring()

    See it: log the count with each message.
    """
    return told(case, "missing-summary")


@shown(
    "fewer-summaries",
    name="missing summary",
    symptom=Symptom.NOT_LOGGED,
    says="when messages come fast, most summaries are left out",
    do="Log a summary at every tenth message, however soon it comes after the one before.",
)
def fewer(case: Case) -> Iterator[Found]:
    """Summaries are left out when messages come fast.

    A timer that looks once a second misses what happens in between, and so does a throttled log call.

    Bad:

        self.create_timer(1.0, self.ring_if_full)

    Good:

        self.visitors += 1
        self.ring_if_full()

    See it: `ros2 topic pub -r 25 TOPIC TYPE VALUES`, and the log.
    """
    return told(case, "fewer-summaries")


@shown(
    "no-summary",
    symptom=Symptom.NOT_LOGGED,
    says="{seen_instead}",
    do="Let the callback log a summary with the node's own logger; publish a message by hand to see how far it gets.",
    logged=True,
)
def no_summary(case: Case) -> Iterator[Found]:
    """Messages come, but nothing sums them up.

    A subscription's callback is where a node learns of a message, so that is where it can count and log.

    Bad:

        def on_ring(self, message):
            pass

    Good:

        def on_ring(self, message):
            self.visitors += 1
            self.get_logger().info(f'{self.visitors} visitors')

    See it: `ros2 topic echo /rosout`.
    """
    if case.about("fault") == "no-summary":
        logs = "none of its log messages is a summary"
        yield Found({"seen_instead": logs if case.about("logged") else "no log message follows a message"})


@CATALOGUE.mistake(
    "log-throttled",
    explains=[Symptom.NOT_LOGGED],
    says="{line} lets through one summary in each throttle_duration_sec, and drops the others: {code}",
    do="Log the summary without throttle_duration_sec.",
    example=in_run(Symptom.NOT_LOGGED, fault="fewer-summaries"),
)
def throttled(case: Case) -> Iterator[Found]:
    """A log call is throttled.

    With throttle_duration_sec, a log call makes at most one message in so many seconds. That is good against floods of
    the same warning, but wrong for what everybody has to see.

    Bad:

        self.get_logger().info(f'{self.visitors} visitors', throttle_duration_sec=1.0)

    Good:

        self.get_logger().info(f'{self.visitors} visitors')

    See it: `ros2 topic pub -r 25 TOPIC TYPE VALUES`, and the log.
    """
    for file in case.files if case.about("fault") == "fewer-summaries" else ():
        for node in file.nodes:
            if isinstance(node, ast.Call) and any(keyword.arg == "throttle_duration_sec" for keyword in node.keywords):
                yield found(file, node)
