"""What a symptom of messages that arrive in part, or twice, says where nothing else explains it."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found
from tutor.mistakes.symptom_entries import in_words, symptom


@symptom("messages-lost", explains=[Symptom.MESSAGES_LOST])
def messages_lost(case: Case) -> Iterator[Found]:
    """Only some of the messages are handled.

    What arrives waits in the subscription's queue, then the callback gets it, one message after the other. Some are
    left out if the queue overflows, or if the callback skips them: a filter, a throttled log message, a variable that
    keeps only the newest.

    Bad:

        self.get_logger().info(message.data, throttle_duration_sec=1.0)

    Good:

        self.get_logger().info(message.data)

    See it: count in the callback, and compare with what was sent.
    """
    topic, sent, shown = case.about("topic", "the topic"), case.about("sent"), case.about("shown")
    return in_words(
        case,
        f"{shown} of {sent} messages on {topic} are shown" if sent else f"not all messages on {topic} are shown",
        "Count what the callback is called for: if that is all, look for what leaves messages out on the way from "
        "there; if not, compare how long the callback takes with how many messages may wait for it in the queue.",
    )


@symptom("shown-again", explains=[Symptom.SHOWN_AGAIN])
def shown_again(case: Case) -> Iterator[Found]:
    """A message is shown more than once.

    A callback is called once for each message. What is kept in a variable, and shown again whenever a timer or another
    callback runs, looks as if it had arrived again.

    Bad:

        self.create_timer(1.0, lambda: self.get_logger().info(self.last_ring))

    Good:

        self.create_subscription(String, 'ring', lambda ring: self.get_logger().info(ring.data), 10)

    See it: the log in the app, beside what you know was sent.
    """
    return in_words(
        case,
        f"a message that came once on {case.about('topic', 'the topic')} is logged more than once",
        "Log a message only in the callback that gets it, and in one log message.",
    )


@symptom("shown-together", explains=[Symptom.SHOWN_TOGETHER])
def shown_together(case: Case) -> Iterator[Found]:
    """Several messages are shown in one log message.

    A log message has one time and one level, and a filter shows it or hides it as a whole. What is collected first
    comes late, and what is left over at the end does not come at all; a log message that gets too long is cut off.

    Bad:

        self.rings.append(ring.data)
        if len(self.rings) == 10:
            self.get_logger().info(', '.join(self.rings))

    Good:

        self.get_logger().info(ring.data)

    See it: the log in the app, where each log message begins on a line of its own.
    """
    return in_words(
        case,
        f"several messages on {case.about('topic', 'the topic')} are in one log message",
        "Log each message in the callback that gets it, without waiting for the next one.",
    )
