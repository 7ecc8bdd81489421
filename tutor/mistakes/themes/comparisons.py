"""Comparisons that never hold."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.mistakes.themes.unread_attributes import DECISIONS

_TRUTHS = {"true", "1", "on", "false", "0", "off"}


@mistake(
    "types-never-equal",
    explains=DECISIONS,
    says="{line} compares a Parameter.Type with a number from ParameterType, and the two are never equal: {code}",
    do="Compare it with the Parameter.Type of that name, or compare its .value.",
)
def compared_types(case: Case) -> Iterator[Found]:
    """Two kinds of type constants are compared.

    parameter.type_ is a Parameter.Type; the message ParameterType has plain numbers with the same meaning. One never
    equals the other.

    Bad:

        if parameter.type_ == ParameterType.PARAMETER_DOUBLE:
            self.volume = parameter.value

    Good:

        if parameter.type_ == Parameter.Type.DOUBLE:
            self.volume = parameter.value

    See it: log the comparison.
    """
    for file in case.files:
        for node in file.nodes:
            if isinstance(node, ast.Compare) and isinstance(node.left, ast.Attribute):
                constants = [ast.unparse(value) for value in node.comparators]
                if node.left.attr in ("type_", "type") and any("PARAMETER_" in constant for constant in constants):
                    yield found(file, node)


@mistake(
    "compared-with-a-text",
    explains=DECISIONS,
    says="{line} compares a boolean parameter with the text {text}, which it never equals: {code}",
    do="Use the value itself as the condition.",
)
def bool_with_text(case: Case) -> Iterator[Found]:
    """A boolean is compared with a text.

    A parameter declared with True or False has a boolean as its value, not the text "true". They are never equal.

    Bad:

        if self.get_parameter('muted').value == 'true':
            return

    Good:

        if self.get_parameter('muted').value:
            return

    See it: log the value and its type.
    """
    for file in case.files:
        for node in file.nodes:
            match node:
                case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq()], comparators=[right]):
                    compared, literal = (left, right) if isinstance(right, ast.Constant) else (right, left)
                case _:
                    continue
            text = literal.value if isinstance(literal, ast.Constant) else None
            if isinstance(text, str) and text.lower() in _TRUTHS and _is_value(compared):
                yield found(file, node, text=repr(text))


def _is_value(expression: ast.expr) -> bool:
    """Whether this is `x.value` or `str(x.value)`; comparing `str(x.value).lower()` is correct."""
    match expression:
        case ast.Call(func=ast.Name(id="str"), args=[inner]):
            return _is_value(inner)
        case ast.Attribute(attr="value" | "bool_value"):
            return True
    return False


@mistake(
    "never-the-same-object",
    explains=DECISIONS,
    slip=True,
    says="{line} asks with `is` whether two values are the same object, which equal values need not be: {code}",
    do="Compare them with == there (or != in place of `is not`).",
)
def identity(case: Case) -> Iterator[Found]:
    """Values are compared with `is`.

    `is` asks whether both sides are the same object in memory. Two equal texts or numbers may be two objects.

    Bad:

        if parameter.name is 'volume':
            self.volume = parameter.value

    Good:

        if parameter.name == 'volume':
            self.volume = parameter.value

    See it: Python warns: "is" with a literal.
    """
    for file in case.files:
        for node in file.nodes:
            match node:
                case ast.Compare(ops=[ast.Is() | ast.IsNot()], comparators=[ast.Constant(value=value)]):
                    if type(value) in (str, int, float):
                        yield found(file, node)
