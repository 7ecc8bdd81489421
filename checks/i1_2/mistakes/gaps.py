"""I1.2: why gaps are reported wrongly, or not at all."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from checks.i1_2 import comparing
from checks.i1_2.mistakes.entries import CATALOGUE, shown, told
from checks.i1_2.parsing import find_misread
from tutor.judge.symptom import Symptom
from tutor.mistakes import Case, Found, found
from tutor.mistakes.examples import in_run
from tutor.source import Function

_ALARM, _UNNOTICED, _ZERO = "false-alarm", "gap-not-noticed", "0-taken-for-no-number"
_MISSED = "5 numbers are missing"


def _callbacks(case: Case, *faults: str) -> list[Function]:
    return case.program.callbacks("create_subscription") if case.about("fault") in faults else []


@CATALOGUE.mistake(
    "number-misread",
    explains=[Symptom.WRONG_LOG, Symptom.NOT_LOGGED],
    says="{line}: {text}",
    do="Take the whole number, and nothing else: it is all that comes after the colon.",
    example=in_run(Symptom.WRONG_LOG, fault=_ALARM),
)
def misread(case: Case) -> Iterator[Found]:
    """A number is taken from the wrong place of a text.

    A position that is right for a number of one digit is wrong for one of two. What stands around the number does not
    change, so look for that.

    Bad:

        def __init__(self):
            self.create_subscription(String, 'doors', self.on_door, 10)

        def on_door(self, message):
            number = int(message.data[-1])

    Good:

        def __init__(self):
            self.create_subscription(String, 'doors', self.on_door, 10)

        def on_door(self, message):
            number = int(message.data.rpartition(' ')[2])

    See it: log the number beside the text, from 8 to 12.
    """
    if (wrong := find_misread(_callbacks(case, _ALARM, _UNNOTICED))) is not None:
        yield found(case.program.holding(wrong.node), wrong.node, text=wrong.text)


@CATALOGUE.mistake(
    "number-compared-with-the-count",
    explains=[Symptom.WRONG_LOG, Symptom.NOT_LOGGED],
    says="{line} compares a message's number with {counter}, how many have come: these differ for anyone who starts "
    "late, and for good after a gap",
    do="Compare it with the number of the message before.",
    example=in_run(Symptom.WRONG_LOG, fault=_ALARM),
)
def count_compared(case: Case) -> Iterator[Found]:
    """The sender's number is compared with the receiver's count.

    The two are the same only for a subscriber that was there from the beginning and has missed nothing. After one gap,
    they differ for good.

    Bad:

        def __init__(self):
            self.opened = 0
            self.create_subscription(Int32, 'doors', self.on_door, 10)

        def on_door(self, message):
            number = int(message.data)
            self.opened += 1
            if number != self.opened:
                self.get_logger().warning('a door was missed')

    Good:

        def __init__(self):
            self.create_subscription(Int32, 'doors', self.on_door, 10)

        def on_door(self, message):
            number = int(message.data)
            if number != self.last_number + 1:
                self.get_logger().warning('a door was missed')
            self.last_number = number

    See it: start the subscriber a while after the publisher.
    """
    for node, counter in comparing.with_the_count(case.program, _callbacks(case, _ALARM, _UNNOTICED)):
        yield found(case.program.holding(node), node, counter=counter)


@CATALOGUE.mistake(
    "last-number-out-of-date",
    explains=[Symptom.WRONG_LOG],
    says="{line} compares with {last}, which {why}",
    do="Let it have the number of the message before, for every message, also after a gap.",
    example=in_run(Symptom.WRONG_LOG, fault=_ALARM),
)
def out_of_date(case: Case) -> Iterator[Found]:
    """A number is compared with one from long ago.

    The last number has to follow each message. If it is set only when all is well, or counts on by itself, it stays
    behind after the first gap, and every later message looks like another one.

    Bad:

        def __init__(self):
            self.create_subscription(Int32, 'doors', self.on_door, 10)

        def on_door(self, message):
            number = int(message.data)
            if number != self.last_number + 1:
                self.get_logger().warning('a door was missed')
            else:
                self.last_number = number

    Good:

        def __init__(self):
            self.create_subscription(Int32, 'doors', self.on_door, 10)

        def on_door(self, message):
            number = int(message.data)
            if number != self.last_number + 1:
                self.get_logger().warning('a door was missed')
            self.last_number = number

    See it: log both numbers with each message.
    """
    for function in _callbacks(case, _ALARM):
        for _, last, node in comparing.comparisons(function):
            if why := comparing.find_missing_update(function, last, case.program.holding(node)):
                yield found(case.program.holding(node), node, last=last, why=why)


@CATALOGUE.mistake(
    "last-number-set-too-early",
    explains=[Symptom.NOT_LOGGED],
    says="{line} comes before line {later} compares the two, so they are always the same: {code}",
    do="Keep the new number only once it has been compared.",
    example=in_run(Symptom.NOT_LOGGED, fault=_UNNOTICED),
)
def early_update(case: Case) -> Iterator[Found]:
    """A value is replaced before it is compared.

    After an assignment, both names have the same value, and no comparison finds a difference.

    Bad:

        def __init__(self):
            self.create_subscription(Int32, 'doors', self.on_door, 10)

        def on_door(self, message):
            number = int(message.data)
            self.last_number = number
            if number != self.last_number:
                self.get_logger().warning('another door')

    Good:

        def __init__(self):
            self.create_subscription(Int32, 'doors', self.on_door, 10)

        def on_door(self, message):
            number = int(message.data)
            if number != self.last_number:
                self.get_logger().warning('another door')
            self.last_number = number

    See it: log both numbers with each message.
    """
    for function in _callbacks(case, _UNNOTICED):
        for number, last, node in comparing.comparisons(function):
            for each in (each for each in function.body if isinstance(each, ast.Assign)):
                if each.lineno < node.lineno and comparing.assigns_to(each, last) and ast.unparse(each.value) == number:
                    yield found(case.program.holding(node), each, later=node.lineno)


@CATALOGUE.mistake(
    "only-lower-numbers",
    explains=[Symptom.NOT_LOGGED],
    says="{line} finds lower numbers only, and nothing looks for higher ones: {code}",
    do="Find also a number that is higher than the next one should be.",
    example=in_run(Symptom.NOT_LOGGED, fault=_UNNOTICED),
)
def lower_only(case: Case) -> Iterator[Found]:
    """A comparison looks one way only.

    A number that is lower than the last means that the publisher has started again. Where messages are missing, it is
    higher than the next one should be.

    Bad:

        def __init__(self):
            self.create_subscription(Int32, 'doors', self.on_door, 10)

        def on_door(self, message):
            number = int(message.data)
            if number < self.last_number:
                self.get_logger().warning('a door was missed')
            self.last_number = number

    Good:

        def __init__(self):
            self.create_subscription(Int32, 'doors', self.on_door, 10)

        def on_door(self, message):
            number = int(message.data)
            if number > self.last_number + 1:
                self.get_logger().warning('a door was missed')
            self.last_number = number

    See it: publish 1, 2 and 5 by hand.
    """
    for function in _callbacks(case, _UNNOTICED):
        if (node := comparing.find_lower_only(function)) is not None:
            yield found(case.program.holding(node), node)


@CATALOGUE.mistake(
    "0-tested-for-truth",
    explains=[Symptom.NOT_LOGGED],
    says="{line}: {tested} is not true when it is 0, though 0 is a number like any other: {code}",
    do="Ask for `is None` or `is not None`.",
    example=in_run(Symptom.NOT_LOGGED, fault=_ZERO),
)
def tested_for_truth(case: Case) -> Iterator[Found]:
    """0 is taken for nothing.

    In a condition, 0 and None are both false. Whoever means "is there a value" has to ask whether it is None.

    Bad:

        def __init__(self):
            self.create_subscription(Int32, 'doors', self.on_door, 10)

        def on_door(self, message):
            if self.last_number and message.data != self.last_number + 1:
                self.get_logger().warning('a door was missed')

    Good:

        def __init__(self):
            self.create_subscription(Int32, 'doors', self.on_door, 10)

        def on_door(self, message):
            if self.last_number is not None and message.data != self.last_number + 1:
                self.get_logger().warning('a door was missed')

    See it: `python3 -c "print(bool(0))"`.
    """
    for function in _callbacks(case, _ZERO):
        if (tested := comparing.find_truth_test(function)) is not None:
            yield found(case.program.holding(tested), tested, tested=ast.unparse(tested))


@shown(
    "0-taken-for-no-number",
    symptom=Symptom.NOT_LOGGED,
    says="a jump from another number is noticed, but not one from 0",
    do="See what your condition does where the last number is 0: in Python, 0 is false, as None is.",
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
    return told(case, _ZERO)


@shown(
    _ALARM,
    says="{what}",
    do="Follow one of these messages, which lacks nothing, through the condition to see which two values differ there.",
    what="it also says so where N rises by one: gap at 10",
)
def false_alarm(case: Case) -> Iterator[Found]:
    """A loss is reported where nothing is lost.

    Numbers rise by one from each message to the next. What compares texts or single digits, or keeps an old number,
    finds gaps where there are none.

    Bad:

        if message.data[-1] < self.last_digit:

    Good:

        if number > self.last_number + 1:

    See it: log the two values that you compare, with each message.
    """
    return told(case, _ALARM)


@shown(
    _UNNOTICED,
    symptom=Symptom.NOT_LOGGED,
    says="{missed}, and nothing in the log tells this from any other message",
    do="Work out from a message's number, and that of the one before, whether any are missing between them.",
    missed=_MISSED,
)
def unnoticed(case: Case) -> Iterator[Found]:
    """A gap is not noticed.

    DDS does not say which messages of a best-effort topic were lost. A subscriber finds out by a number in the messages
    that rises by one.

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
    return told(case, _UNNOTICED)


@shown(
    "negative-number-of-missing-messages",
    says="the number falls when the publisher starts again; then the difference of the two is no count of messages",
    do="Let a lower number mean a restart, and count missing messages only where the number is too high.",
)
def negative(case: Case) -> Iterator[Found]:
    """A negative number of messages is said to be missing.

    A publisher that starts again begins with a low number. The difference to the last one is negative, and counts
    nothing.

    Bad:

        self.missed += number - self.last_number - 1

    Good:

        if number > self.last_number:
            self.missed += number - self.last_number - 1

    See it: stop the publisher and start it again.
    """
    return told(case, "negative-number-of-missing-messages")
