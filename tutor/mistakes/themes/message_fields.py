"""Messages whose fields do not get what the code gives them."""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.source import NodeFile, last_name, values_of

_WRONG = (
    Symptom.WRONG_VALUES,
    Symptom.WRONG_ANSWER,
    Symptom.REFUSED,
    Symptom.BAD_VALUE_ACCEPTED,
    Symptom.NO_MESSAGES,
    Symptom.CALLS_MISSING,
    Symptom.CHANGE_IGNORED,
)
_NARROW = ("float32", "float16", "single", "half")


@cache
def _fields() -> Mapping[str, tuple[str, ...]]:
    """The fields of common types, by name, such as "Bool" or "SetBool.Response"."""
    text = Path(__file__).with_name("message_fields.toml").read_text(encoding="utf-8")
    return {name: tuple(fields.split()) for name, fields in tomllib.loads(text).items()}


@mistake(
    "unknown-field-in-a-constructor",
    explains=_WRONG,
    slip=True,
    says="{line}: {type} has no field {given}, which is dropped without a word: {code}",
    do="{step}",
    remark="{type} has no field {given}: it is dropped without a word.",
)
def unknown_field(case: Case) -> Iterator[Found]:
    """The constructor of a message is given a field that it does not have.

    A message takes its fields by name. In Jazzy, a name that it does not know is dropped without a word, and the
    intended field keeps its default: 0, an empty text, or False.

    Bad:

        from std_msgs.msg import Bool

        horn = Bool(value=True)

    Good:

        from std_msgs.msg import Bool

        horn = Bool(data=True)

    See it: `ros2 interface show std_msgs/msg/Bool`; `ros2 topic echo` shows the default.
    """
    for file in case.files:
        for call in (node for node in file.nodes if isinstance(node, ast.Call)):
            name = _interface(file, call.func)
            if name is None:
                continue
            fields = _fields()[name]
            for keyword in call.keywords:
                if keyword.arg is not None and keyword.arg not in fields:
                    step = (
                        f"Use the field {' or '.join(fields)} there."
                        if fields
                        else "Leave it out: there are no fields."
                    )
                    yield found(file, call, type=name, given=keyword.arg, step=step)


def _interface(file: NodeFile, called: ast.expr) -> str | None:
    """The type of ROS that a call makes, such as "SetBool.Response", if it is imported from a package of them."""
    code = ast.unparse(called)
    for statement, alias in file.imports:
        package = statement.module if isinstance(statement, ast.ImportFrom) else alias.name
        if not (package or "").endswith((".msg", ".srv")):
            continue
        if isinstance(statement, ast.Import):
            prefix, name = f"{alias.asname or alias.name}.", ""
        else:
            prefix, name = alias.asname or alias.name, alias.name
        if code.startswith(prefix) and (full := f"{name}{code.removeprefix(prefix)}") in _fields():
            return full
    return None


@mistake(
    "narrow-float-in-a-float-field",
    explains=(Symptom.WRONG_VALUES, Symptom.NO_MESSAGES),
    says="{line} puts numpy's {kind} into a field that takes a Python float: {code}",
    do="Convert it with float() before it goes into the message.",
)
def narrow_float(case: Case) -> Iterator[Found]:
    """A numpy float32 goes into a float field.

    numpy's float64 is a Python float; its float32 is not. rclpy reads the field as a Python float without checking, and
    sends a number that has nothing to do with the value.

    Bad:

        level = Float64(data=np.float32(7.5))

    Good:

        level = Float64(data=float(np.float32(7.5)))

    See it: `ros2 topic echo TOPIC` shows numbers close to 0.
    """
    for file in case.files:
        for value, given in field_values(file):
            if (kind := _narrow(given)) is not None:
                yield found(file, value, kind=kind)


def field_values(file: NodeFile) -> Iterator[tuple[ast.expr, ast.expr]]:
    """What is given to a field `data`, each with itself, or with each value assigned to that variable or attribute."""
    for node in file.nodes:
        match node:
            case ast.keyword(arg="data", value=value) | ast.Assign(targets=[ast.Attribute(attr="data")], value=value):
                around = (file.function_around(value) or file.tree) if isinstance(value, ast.Name) else file.tree
                kept = values_of(ast.unparse(value), around) if isinstance(value, ast.Name | ast.Attribute) else []
                yield from ((value, given) for given in kept or [value])


def is_int(value: ast.expr) -> bool:
    """Whether an expression is surely an int."""
    match value:
        case ast.Constant(value=number):
            return type(number) is int
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult() | ast.Mod() | ast.FloorDiv(), right=right):
            return is_int(left) and is_int(right)
        case ast.Call(func=function, args=args):
            name = last_name(function)
            return name in ("int", "len", "randint", "randrange") or (name == "round" and len(args) == 1)
    return False


def _narrow(value: ast.expr) -> str | None:
    """The numpy type of an expression that is surely narrower than a Python float, such as "float32"."""
    match value:
        case ast.Call(func=ast.Attribute(attr="astype"), args=[kind]) if last_name(kind) in _NARROW:
            return last_name(kind)
        case ast.Call(func=function) if last_name(function) in _NARROW:
            return last_name(function)
        case ast.Call(keywords=keywords):
            given = [keyword.value for keyword in keywords if keyword.arg == "dtype"]
            names = [str(dtype.value) if isinstance(dtype, ast.Constant) else last_name(dtype) for dtype in given]
            return next((name for name in names if name in _NARROW), None)
        case ast.BinOp(left=left, right=right):
            return _narrow(left) or _narrow(right)
    return None
