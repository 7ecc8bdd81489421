"""I1.2: what the judges have seen of gaps, where the source does not show why."""

from __future__ import annotations

from collections.abc import Iterator

from checks.i1_2_message_statistics.mistakes.entries import shown, told
from tutor.judge.symptom import Symptom
from tutor.mistakes import Case, Found

ALARM, UNNOTICED, ZERO = "false-alarm", "gap-not-noticed", "0-taken-for-no-number"
_MISSED = "5 numbers are missing"


@shown(
    "0-taken-for-no-number",
    symptom=Symptom.NOT_LOGGED,
    says="a jump from any other number is noticed, but not one from 0",
    do="See what your condition does when the last number is 0: in Python, 0 is false, as None is.",
)
def zero(case: Case) -> Iterator[Found]:
    """0 counts as no number.

    A first value of 0 or -1, or a test for truth, cannot tell "none yet" from a number that really came.

    Bad:

        if self.last_number and number != self.last_number + 1:

    Good:

        if self.last_number is not None and number != self.last_number + 1:

    See it: publish 0 and then 5 by hand.
    """
    return told(case, ZERO)


@shown(
    ALARM,
    says="{what}",
    do="Follow such a message, before which none is missing, through your condition: which two values differ there?",
    what="it also reports one where N rises by one: gap at 10",
)
def false_alarm(case: Case) -> Iterator[Found]:
    """A loss is reported where nothing is lost.

    Numbers rise by one from each message to the next. Code that compares texts or single digits, or keeps an old
    number, finds gaps where there are none.

    Bad:

        if message.data[-1] < self.last_digit:

    Good:

        if number > self.last_number + 1:

    See it: log the two values that you compare, with each message.
    """
    return told(case, ALARM)


@shown(
    UNNOTICED,
    symptom=Symptom.NOT_LOGGED,
    says="{missed}, but nothing in the log shows it",
    do="From a message's number, and that of the one before, work out whether any are missing in between.",
    missed=_MISSED,
)
def unnoticed(case: Case) -> Iterator[Found]:
    """A gap is not noticed.

    DDS does not say which messages were lost. A subscriber can tell if the messages carry a number that rises by one
    each time.

    Bad:

        def on_door(self, message):
            self.opened += 1

    Good:

        def on_door(self, message):
            if self.last_number is not None and message.number > self.last_number + 1:
                self.get_logger().warning('some doors are missing')
            self.last_number = message.number

    See it: publish 1, 2 and 5 by hand, and read the log.
    """
    return told(case, UNNOTICED)


@shown(
    "negative-number-of-missing-messages",
    says="when the publisher starts again the number falls, and the difference is no longer a count of messages",
    do="Let a lower number mean a restart, and count missing messages only where the number is too high.",
)
def negative(case: Case) -> Iterator[Found]:
    """A negative number of messages is reported missing.

    A publisher that starts again begins with a low number. The difference from the last one is then negative, and
    counts nothing.

    Bad:

        self.missed += number - self.last_number - 1

    Good:

        if number > self.last_number:
            self.missed += number - self.last_number - 1

    See it: stop the publisher and start it again.
    """
    return told(case, "negative-number-of-missing-messages")
