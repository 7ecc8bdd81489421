"""I1.2: mistakes in the count of messages."""

from __future__ import annotations

from collections.abc import Iterator

from checks.i1_2_message_statistics.mistakes.entries import shown, told
from tutor.mistakes import Case, Found


@shown(
    "missed-messages-counted",
    says="it says {stated}, but {missed} of these never arrived",
    do="Count only what the callback is called for, and keep the number of missing messages separately.",
    stated=31,
    missed=4,
)
def missed_counted(case: Case) -> Iterator[Found]:
    """Messages that never came are counted.

    How many messages have come and how many should have come are two numbers. If what is missing is added to the first,
    both are lost.

    Bad:

        self.visitors += number - self.last_number

    Good:

        self.visitors += 1

    See it: skip some numbers when you publish by hand, and read the log.
    """
    return told(case, "missed-messages-counted")


@shown(
    "number-taken-for-the-count",
    says="it gives the number in “{content}”, not how many messages have come",
    do="Let the node count for itself: a node that starts late, or misses a message, has received fewer than that.",
    content="Hello World: 97",
)
def number_as_count(case: Case) -> Iterator[Found]:
    """The sender's number is taken for the receiver's count.

    The number in a message says how many the publisher has sent. A subscriber that starts late, or misses some, has
    received fewer.

    Bad:

        self.visitors = message.number

    Good:

        self.visitors += 1

    See it: start the subscriber a while after the publisher.
    """
    return told(case, "number-taken-for-the-count")


@shown(
    "off-by-one",
    says="it says {stated} after {sent} messages",
    do="Follow the count to the log: what is it before the first message, and is it raised before it is logged?",
    stated=30,
    sent=29,
)
def off_by_one(case: Case) -> Iterator[Found]:
    """A count is one too high or too low.

    A counter starts at 0, and is raised once for each message, before it is used. A first value of 1, or a log message
    before the addition, makes it wrong by one.

    Bad:

        self.get_logger().info(f'{self.visitors} visitors')
        self.visitors += 1

    Good:

        self.visitors += 1
        self.get_logger().info(f'{self.visitors} visitors')

    See it: publish one message by hand, and read the log.
    """
    return told(case, "off-by-one")


@shown(
    "wrong-count",
    says="{what}",
    do="Find each line that changes the count: one addition for each message, and nothing that sets it back.",
    what="none of its numbers (1) is 30",
)
def wrong_count(case: Case) -> Iterator[Found]:
    """A count is not the number of messages.

    Messages are counted by an attribute that lives as long as the node, and that the callback raises by one. A local
    variable starts anew in each call, and the length of a bounded list stops growing.

    Bad:

        visitors = 0
        visitors += 1

    Good:

        self.visitors += 1

    See it: log the count with each message for a while.
    """
    return told(case, "wrong-count")


@shown(
    "count-and-rate-swapped",
    says="it gives {number}, which is how many messages came, as messages per second",
    do="Compare the order of the values with that of the words around them.",
    number="30.00",
)
def swapped(case: Case) -> Iterator[Found]:
    """Two values are swapped.

    format() and % take values in the order in which they are given, whatever the words around them say. An f-string has
    each value where it is shown.

    Bad:

        '{} doors, {} per hour'.format(self.per_hour, self.doors)

    Good:

        f'{self.doors} doors, {self.per_hour} per hour'

    See it: the log, with numbers that you know.
    """
    return told(case, "count-and-rate-swapped")
