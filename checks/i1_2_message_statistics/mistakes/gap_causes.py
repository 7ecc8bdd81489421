"""I1.2: why gaps are reported wrongly, or not at all, by the source."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from checks.i1_2_message_statistics.mistakes import number_comparisons
from checks.i1_2_message_statistics.mistakes.entries import CATALOGUE
from checks.i1_2_message_statistics.mistakes.gap_faults import ALARM, UNNOTICED, ZERO
from checks.i1_2_message_statistics.mistakes.number_parsing import find_misread
from tutor.judge.symptom import Symptom
from tutor.mistakes import Case, Found, found
from tutor.mistakes.examples import in_run
from tutor.source import Function, argument


def _callbacks(case: Case, *faults: str) -> list[Function]:
    return case.program.callbacks("create_subscription") if case.about("fault") in faults else []


@CATALOGUE.mistake(
    "number-misread",
    explains=[Symptom.WRONG_LOG, Symptom.NOT_LOGGED],
    says="{line}: {text}",
    do="Take the whole number and nothing else: it is everything after the colon.",
    example=in_run(Symptom.WRONG_LOG, fault=ALARM),
)
def misread(case: Case) -> Iterator[Found]:
    """A number is taken from the wrong place of a text.

    A position that is right for a one-digit number is wrong for one of two digits. The text around the number does not
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
    if (wrong := find_misread(_callbacks(case, ALARM, UNNOTICED))) is not None:
        yield found(case.program.holding(wrong.node), wrong.node, text=wrong.text)


@CATALOGUE.mistake(
    "number-compared-with-the-count",
    explains=[Symptom.WRONG_LOG, Symptom.NOT_LOGGED],
    says="{line} compares a message's number with {counter}, a count: the two differ if the node starts late, and for "
    "good after a gap",
    do="Compare it with the number of the message before.",
    example=in_run(Symptom.WRONG_LOG, fault=ALARM),
)
def count_compared(case: Case) -> Iterator[Found]:
    """The sender's number is compared with the receiver's count.

    The two are the same only for a subscriber that was there from the start and has missed nothing. After one gap, they
    differ for good.

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
    for node, counter in number_comparisons.with_the_count(case.program, _callbacks(case, ALARM, UNNOTICED)):
        yield found(case.program.holding(node), node, counter=counter)


@CATALOGUE.mistake(
    "last-number-out-of-date",
    explains=[Symptom.WRONG_LOG],
    says="{line} compares with {last}, which {why}",
    do="Update it with every message, even after a gap, so that it has the number of the message before.",
    example=in_run(Symptom.WRONG_LOG, fault=ALARM),
)
def out_of_date(case: Case) -> Iterator[Found]:
    """A number is compared with one from long ago.

    The last number has to follow each message. If it is set only when all is well, or merely counts up, it falls behind
    at the first gap, and every later message looks like another gap.

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
    for function in _callbacks(case, ALARM):
        for _, last, node in number_comparisons.comparisons(function):
            if why := number_comparisons.find_missing_update(function, last, case.program.holding(node)):
                yield found(case.program.holding(node), node, last=last, why=why)


@CATALOGUE.mistake(
    "last-number-set-too-early",
    explains=[Symptom.NOT_LOGGED],
    says="{line} comes before line {later} compares the two, so they are always the same: {code}",
    do="Keep the new number only once it has been compared.",
    example=in_run(Symptom.NOT_LOGGED, fault=UNNOTICED),
)
def early_update(case: Case) -> Iterator[Found]:
    """A value is replaced before it is compared.

    After the assignment, both names have the same value, and no comparison finds a difference.

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
    for function in _callbacks(case, UNNOTICED):
        for number, last, node in number_comparisons.comparisons(function):
            for assignment in (statement for statement in function.body if isinstance(statement, ast.Assign)):
                if (
                    assignment.lineno < node.lineno
                    and number_comparisons.assigns_to(assignment, last)
                    and ast.unparse(assignment.value) == number
                ):
                    yield found(case.program.holding(node), assignment, later=node.lineno)


@CATALOGUE.mistake(
    "only-lower-numbers",
    explains=[Symptom.NOT_LOGGED],
    says="{line} finds lower numbers only, but nothing looks for higher ones: {code}",
    do="Also look for a number that is higher than the next one should be.",
    example=in_run(Symptom.NOT_LOGGED, fault=UNNOTICED),
)
def lower_only(case: Case) -> Iterator[Found]:
    """A comparison looks only one way.

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
    for function in _callbacks(case, UNNOTICED):
        if (node := number_comparisons.find_lower_only(function)) is not None:
            yield found(case.program.holding(node), node)


@CATALOGUE.mistake(
    "0-tested-for-truth",
    explains=[Symptom.NOT_LOGGED],
    says="{line}: {tested} counts as false when it is 0, though 0 is a number like any other: {code}",
    do="Ask for `is None` or `is not None`.",
    example=in_run(Symptom.NOT_LOGGED, fault=ZERO),
)
def tested_for_truth(case: Case) -> Iterator[Found]:
    """0 is taken for no value.

    In a condition, 0 and None are both false. To ask whether there is a value, ask whether it is None.

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
    for function in _callbacks(case, ZERO):
        if (tested := number_comparisons.find_truth_test(function, case.program)) is not None:
            yield found(case.program.holding(tested), tested, tested=ast.unparse(tested))


@CATALOGUE.mistake(
    "lost-on-the-way-only",
    explains=[Symptom.NOT_LOGGED],
    says="{line} reports messages that DDS loses on their way, which a number that was never sent is not: {code}",
    do="Work out from the numbers in two messages whether one is missing between them.",
    example=in_run(Symptom.NOT_LOGGED, fault=UNNOTICED),
)
def lost_on_the_way(case: Case) -> Iterator[Found]:
    """The message_lost event is taken for a gap in the numbers.

    DDS counts what a publisher has sent, and reports a loss if a message does not arrive. It does not read the
    messages: a number that the sender left out is no loss to it.

    Bad:

        events = SubscriptionEventCallbacks(message_lost=self.on_lost)
        self.create_subscription(Int32, 'doors', self.on_door, 10, event_callbacks=events)

    Good:

        self.create_subscription(Int32, 'doors', self.on_door, 10)

    See it: publish 1, 2 and 5 by hand: DDS has lost nothing.
    """
    for file in case.files if case.about("fault") in (UNNOTICED, ZERO) else ():
        for call in file.calls("SubscriptionEventCallbacks"):
            if argument(call, "message_lost") is not None:
                yield found(file, call)
