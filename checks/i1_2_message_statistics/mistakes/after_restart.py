"""I1.2: what goes wrong when another publisher starts over."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from checks.i1_2_message_statistics.mistakes.entries import CATALOGUE, shown, told
from tutor.judge.symptom import Symptom
from tutor.mistakes import Case, Found, found
from tutor.mistakes.examples import in_run

_FAULTS = (
    "wrong-count",
    "first-message-overwritten",
    "starts-over-silently",
    "wrong-count-after-a-restart",
    "false-alarm",
    "gap-not-noticed",
)


@CATALOGUE.mistake(
    "texts-compared",
    explains=[Symptom.WRONG_LOG, Symptom.NOT_LOGGED],
    says="{line} compares texts, and as texts, “10” is less than “9”: {code}",
    do="Take the numbers out of the texts, and compare those.",
    example=in_run(Symptom.WRONG_LOG, fault="starts-over-silently", restarted=10, messages=23),
)
def texts_compared(case: Case) -> Iterator[Found]:
    """Numbers in texts are compared as texts.

    Python compares texts character by character: "10" comes before "9", since "1" does.

    Bad:

        def __init__(self):
            self.create_subscription(String, 'visitors', self.on_visitor, 10)

        def on_visitor(self, message):
            if message.data < self.last:
                self.new_day()
            self.last = message.data

    Good:

        def __init__(self):
            self.create_subscription(String, 'visitors', self.on_visitor, 10)

        def on_visitor(self, message):
            if int(message.data) < self.last:
                self.new_day()
            self.last = int(message.data)

    See it: `python3 -c "print('10' < '9')"`.
    """
    if case.about("fault") not in _FAULTS:
        return
    texts = _texts(case)
    for function in case.program.callbacks("create_subscription"):
        for node in ast.walk(function):
            if isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.Lt | ast.LtE | ast.Gt | ast.GtE):
                operands = (node.left, *node.comparators)
                if len(operands) == 2 and all(_is_text(operand, texts) for operand in operands):
                    yield found(case.program.holding(node), node)


def _texts(case: Case) -> set[str]:
    """The variables that hold nothing but texts, or None."""
    given: dict[str, list[ast.expr]] = {}
    for node in case.program.nodes():
        if isinstance(node, ast.Assign):
            for target in node.targets:
                given.setdefault(ast.unparse(target), []).append(node.value)
    texts: set[str] = set()
    for _ in range(2):  # a variable may be set to another one
        for name, values in given.items():
            values = [value for value in values if not (isinstance(value, ast.Constant) and value.value is None)]
            if values and all(_is_text(value, texts) for value in values):
                texts.add(name)
    return texts


def _is_text(value: ast.expr, texts: set[str]) -> bool:
    """Whether an expression is a text: a message's data, a part of one, or one of the variables `texts`."""
    match value:
        case ast.Attribute(attr="data") | ast.Constant(value=str()):
            return True
        case ast.Call(func=ast.Attribute(attr="strip" | "lstrip" | "rstrip" | "removeprefix" | "replace")):
            return True
        case ast.Subscript(value=ast.Call(func=ast.Attribute(attr="split" | "rsplit" | "partition" | "rpartition"))):
            return not isinstance(value.slice, ast.Slice)
    return ast.unparse(value) in texts


@shown(
    "stopped-counting",
    says="the node is still there, but logs no summary of what the new publisher sends",
    do="Follow a message whose number is not higher than an earlier one: what keeps it from being counted?",
)
def stopped(case: Case) -> Iterator[Found]:
    """A subscriber takes no notice of a new publisher.

    A publisher that starts again begins with its first number. A subscriber that skips lower numbers, or numbers that
    it has seen, takes no notice of it.

    Bad:

        if message.number <= self.highest:
            return

    Good:

        if message.number <= self.highest:
            self.get_logger().info('the counter was set back')

    See it: stop the publisher and start it again.
    """
    return told(case, "stopped-counting")


@shown(
    "starts-over-silently",
    says="it says {restarted} after {messages} messages, and no log message says that it started over",
    do="Keep the total going, or log that the publisher has started again and that you count from zero.",
    restarted=10,
    messages=23,
)
def silently(case: Case) -> Iterator[Found]:
    """A count starts over, but the log does not say so.

    A total that falls is a riddle to whoever reads the log. Either it goes on, or the log says why.

    Bad:

        if number < self.last_number:
            self.visitors = 0

    Good:

        if number < self.last_number:
            self.visitors = 0
            self.get_logger().warning('a new day: counting from zero')

    See it: stop the publisher and start it again.
    """
    return told(case, "starts-over-silently")


@shown(
    "wrong-count-after-a-restart",
    says="{messages} messages in all, {new} of them from the new publisher: it states neither",
    do="Find what changes the count when the number falls: every message, including that one, counts once.",
    messages=20,
    new=7,
)
def wrong_after(case: Case) -> Iterator[Found]:
    """A count is wrong once the publisher has started again.

    A count that is computed from the publisher's numbers falls with them; after a reset that skips the message that
    caused it, the count is one short.

    Bad:

        if number < self.last_number:
            self.visitors = 0
            return

    Good:

        if number < self.last_number:
            self.visitors = 0
        self.visitors += 1

    See it: stop the publisher and start it again.
    """
    return told(case, "wrong-count-after-a-restart")
