"""I1.2: what is missing from a summary, or in the wrong place."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from checks.i1_2_message_statistics.mistakes.entries import CATALOGUE, shown, told
from tutor.judge.symptom import Symptom
from tutor.mistakes import Case, Found, found
from tutor.mistakes.examples import in_run


@CATALOGUE.mistake(
    "content-cut-off",
    explains=[Symptom.WRONG_LOG],
    says="{line} cuts the text before its number: {code}",
    do="Keep the whole text.",
    example=in_run(Symptom.WRONG_LOG, fault="first-message-missing", cut=True, content="Hello World: 0"),
)
def cut_off(case: Case) -> Iterator[Found]:
    """A text is cut to its first characters.

    text[:8] has at most eight characters. What comes after them, such as a number at the end, is lost.

    Bad:

        shown = message.data[:8]

    Good:

        shown = message.data

    See it: the log.
    """
    for file in case.files if case.about("fault") == "first-message-missing" and case.about("cut") else ():
        for node in file.nodes:
            match node:
                case ast.Subscript(slice=ast.Slice(lower=None, upper=ast.expr() as upper, step=None)) if (
                    not ast.unparse(upper).startswith("-")
                ):
                    yield found(file, node)


@shown(
    "first-message-overwritten",
    says="“{content}” was the first one, but it quotes “{quoted}”",
    do="Find each line that sets the first message: only one may, and only when there is none yet.",
    content="Hello World: 0",
    quoted="Hello World: 10",
)
def first_overwritten(case: Case) -> Iterator[Found]:
    """What should keep the first value is set again.

    What should be kept has to be set under a condition that holds only once, and nothing may reset it.

    Bad:

        def on_ring(self, message):
            self.first_visitor = message.data

    Good:

        def on_ring(self, message):
            if self.first_visitor is None:
                self.first_visitor = message.data

    See it: log it with each message.
    """
    return told(case, "first-message-overwritten")


@shown(
    "first-message-missing",
    says="“{content}” is not in it",
    do="Put the content of the first message that came into the summary.",
    content="Hello World: 0",
)
def first_missing(case: Case) -> Iterator[Found]:
    """The first message is not in the summary.

    A callback gets one message at a time. What is needed later from the first has to be kept in an attribute.

    Bad:

        self.get_logger().info(f'now {message.data}')

    Good:

        self.get_logger().info(f'{self.first_visitor} was first, now {message.data}')

    See it: the log.
    """
    return told(case, "first-message-missing")


@shown(
    "last-message-missing",
    says="{what}",
    do="See which message the summary takes as the last: it should be the one that has just come.",
    what="“Hello World: 9” is not in it",
)
def last_missing(case: Case) -> Iterator[Found]:
    """The latest message is not in the summary.

    The last message is the one that the callback has just been given, not the one before it, nor the one with the
    highest number.

    Bad:

        self.get_logger().info(f'last: {self.visitor}')
        self.visitor = message.data

    Good:

        self.visitor = message.data
        self.get_logger().info(f'last: {self.visitor}')

    See it: the log, beside `ros2 topic echo TOPIC`.
    """
    return told(case, "last-message-missing")


@shown(
    "first-and-last-swapped",
    says="it calls “{content}” the last one, and the last one the first",
    do="Compare each of the two values with the word in front of it.",
    content="Hello World: 0",
)
def labels_swapped(case: Case) -> Iterator[Found]:
    """First and last are swapped.

    Nothing checks that the words around a value fit it.

    Bad:

        f'first: {self.latest_visitor}, last: {self.first_visitor}'

    Good:

        f'first: {self.first_visitor}, last: {self.latest_visitor}'

    See it: the log.
    """
    return told(case, "first-and-last-swapped")
