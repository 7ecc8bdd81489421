"""The values of parameters: what overwrites them, and what is not their value at all."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import NodeFile, argument, called_name, values_of
from tutor.source.parameters import DECLARE, constants, kept_value

_IGNORED = (Symptom.CHANGE_IGNORED, Symptom.WRONG_RATE, Symptom.NOT_LOGGED)
_CONVERSIONS = frozenset({"float", "int", "str", "round"})
_OVERRIDES = ("parameter_overrides", "cli_args")


def _name(case: Case) -> str:
    return str(case.about("parameter", ""))


@mistake(
    "value-overwritten-by-the-node",
    explains=_IGNORED,
    says="{line} {what}, so a value given for {name} does not last: {code}",
    do="Remove this, and let the declared default be the only value in the code.",
    example=in_run(Symptom.CHANGE_IGNORED, parameter="volume"),
)
def overwritten(case: Case) -> Iterator[Found]:
    """A node overwrites the value of its own parameter.

    A value given at start-up arrives with the declaration. A set_parameters() or an assignment after it, or
    parameter_overrides in the constructor, replaces it, to the surprise of whoever started the node.

    Bad:

        self.declare_parameter('volume', 7)
        self.volume = self.get_parameter('volume').value
        self.volume = 7

    Good:

        self.declare_parameter('volume', 7)
        self.volume = self.get_parameter('volume').value

    See it: `ros2 param get NODE NAME`, and what the node does.
    """
    name = _name(case)
    for file in case.files:
        for call, what in (*_own_sets(file, name), *_overrides(file, name)):
            yield found(file, call, what=what, name=name)
        if (statement := _reassignment(file, name)) is not None:
            yield found(file, statement, what="assigns a fixed value after it was read", name=name)


def _own_sets(file: NodeFile, name: str) -> Iterator[tuple[ast.Call, str]]:
    for call in file.calls("set_parameters", "set_parameters_atomically"):
        function = file.function_around(call)
        if function is file.setup and any(isinstance(ancestor, ast.If) for ancestor in file.ancestors(call)):
            continue  # a fallback for a bad value
        code = ast.unparse(call) if "[" in ast.unparse(call) or function is None else ast.unparse(function)
        made = [node.id for given in call.args for node in ast.walk(given) if isinstance(node, ast.Name)]
        code = " ".join([code, *(ast.unparse(value) for variable in made for value in values_of(variable, file.tree))])
        if name and name in code:
            yield call, "sets the parameter itself"


def _overrides(file: NodeFile, name: str) -> Iterator[tuple[ast.AST, str]]:
    for call in file.calls(*DECLARE):
        given = argument(call, "ignore_override")
        declared = argument(call, "name") if called_name(call) == "declare_parameter" else argument(call, "parameters")
        own = name in ast.unparse(call) or isinstance(declared, ast.Name | ast.Attribute)  # all, in a loop or table
        if given is not None and ast.unparse(given) == "True" and own:
            yield call, "declares it with ignore_override"
    for call in file.calls("create_node", "Node", "__init__", *file.node_classes):
        for keyword in call.keywords:
            if keyword.arg in _OVERRIDES and _may_name(file, keyword.value, name):
                yield call, f"passes {keyword.arg}, which take precedence over what is given at start-up"
    for options in file.nodes:
        if isinstance(options, ast.Dict):
            for key, value in zip(options.keys, options.values, strict=True):
                if isinstance(key, ast.Constant) and key.value in _OVERRIDES and _may_name(file, value, name):
                    yield options, f"passes {key.value}, which take precedence over what is given at start-up"


def _may_name(file: NodeFile, given: ast.expr, name: str) -> bool:
    """Whether an expression, or what the variable is assigned that it consists of, has this text, or none at all."""
    assigned = values_of(given.id, file.function_around(given) or file.tree) if isinstance(given, ast.Name) else []
    texts = [text for text in constants([given, *assigned]) if isinstance(text, str)]
    return not texts or any(name in text for text in texts)


def _reassignment(file: NodeFile, name: str) -> ast.Assign | None:
    """The statement that overwrites what was kept of a parameter with a constant."""
    kept = kept_value(file, name)
    if kept is None:
        return None
    target = ast.unparse(kept.targets[0] if isinstance(kept, ast.Assign) else kept.target)
    for node in ast.walk(file.tree):
        if not isinstance(node, ast.Assign) or not isinstance(node.value, ast.Constant):
            continue
        function = file.function_around(node)
        same = function is file.function_around(kept)
        later = node.lineno > kept.lineno if same else function is not None and function is not file.setup
        guarded = any(
            isinstance(ancestor, ast.ExceptHandler)
            or (isinstance(ancestor, ast.If) and target in ast.unparse(ancestor.test))
            for ancestor in file.ancestors(node)
        )
        if ast.unparse(node.targets[0]) == target and later and not guarded:  # replacing a bad value is fine
            return node
    return None


@mistake(
    "parameter-value-not-read",
    explains=_IGNORED,
    says="{line} converts a message with a field for each type, not the value: {code}",
    do="Read the parameter's value itself.",
    example=in_run(Symptom.CHANGE_IGNORED, parameter="volume"),
)
def value_message(case: Case) -> Iterator[Found]:
    """get_parameter_value() is taken for the value.

    It returns a message of type ParameterValue, with a field for each possible type: double_value, string_value and so
    on. The value itself is in the parameter's attribute `value`.

    Bad:

        self.volume = float(self.get_parameter('volume').get_parameter_value())

    Good:

        self.volume = float(self.get_parameter('volume').value)

    See it: print it once.
    """
    for file in case.files:
        for call in file.calls("get_parameter_value"):
            around = next(file.ancestors(call), None)
            if (
                isinstance(around, ast.Call)
                and called_name(around) in _CONVERSIONS
                and _name(case) in ast.unparse(call)
            ):
                yield found(file, call)


@mistake(
    "parameter-object",
    explains=_IGNORED,
    slip=True,
    says="{line} uses a Parameter object, not its value: {code}",
    do="Add .value to that call.",
    example=in_run(Symptom.NOT_LOGGED, parameter="owner"),
)
def parameter_object(case: Case) -> Iterator[Found]:
    """The Parameter itself is used where its value is meant.

    get_parameter() and declare_parameter() return a Parameter: an object with a name, a type and a value. In a text, it
    looks like <rclpy.parameter.Parameter object at 0x7f…>.

    Bad:

        self.owner = self.get_parameter('owner')

    Good:

        self.owner = self.get_parameter('owner').value

    See it: log it once.
    """
    for file in case.files:
        for call in file.calls("get_parameter", "declare_parameter"):
            around = next(file.ancestors(call), None)
            kept = ast.unparse(around.targets[0]) if isinstance(around, ast.Assign) else ""
            if kept and re.search(rf"{re.escape(kept)}\.(value|get_parameter_value)\b", file.text):
                continue
            first = next(iter(constants([call])), None)
            if isinstance(around, ast.Assign | ast.FormattedValue) and first == _name(case):
                yield found(file, call)
