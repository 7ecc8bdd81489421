"""Rewrite how a learner's node declares its parameters, and find where it reads them."""

from __future__ import annotations

import ast
import difflib
import re
from collections.abc import Sequence

from tutor.judge.edits import (
    Edit,
    insert_after,
    remove_statement,
    replace_lines,
    replace_node,
    replace_nodes,
)
from tutor.judge.rewriting.node import NodeFile, argument

_READ_CALLS = {"get_parameter", "get_parameter_or", "declare_parameter"}


def declare_parameter(file: NodeFile, name: str, default: object, *, plain: bool = False) -> list[Edit]:
    """Declare a parameter with this default; `plain`: without a descriptor or anything else."""
    code = f"{file.name}.declare_parameter({name!r}, {default!r})"
    for call in file.calls("declare_parameter"):
        given = argument(call, 1, "value")
        if is_text(argument(call, 0, "name"), name):
            return [
                replace_node(file.text, call, code)
                if plain or given is None
                else replace_node(file.text, given, repr(default))
            ]
    for each in ast.walk(file.tree):
        if (given := _default_beside(each, name)) is not None:
            if plain and isinstance(each, ast.Tuple):
                return [replace_node(file.text, each, f"({name!r}, {default!r})")]
            return [replace_node(file.text, given, repr(default))]
    return _below_super(file, code)


def rename_parameter(file: NodeFile, name: str, others: Sequence[str]) -> list[Edit]:
    """Rename a parameter that is declared under a similar name, wherever that name occurs."""
    declared = [argument(each, 0, "name") for each in file.calls("declare_parameter")]
    names = [str(each.value) for each in declared if isinstance(each, ast.Constant)]
    similar = [each for each in names if each not in (name, *others) and _are_similar(each, name)]
    if not similar or name in names:
        return []
    old = similar[0]
    numbers = {each.lineno for each in ast.walk(file.tree) if isinstance(each, ast.Constant) and each.value == old}
    lines = file.text.splitlines()
    quoted = re.compile(rf"(?<=['\"]){re.escape(old)}(?=['\"])")
    return [replace_lines(number, quoted.sub(name, lines[number - 1].strip())) for number in sorted(numbers)]


def _are_similar(one: str, other: str) -> bool:
    return one in other or other in one or difflib.SequenceMatcher(None, one, other).ratio() > 0.6


def declare_once(file: NodeFile, line: int) -> list[Edit]:
    """Move the declarations in this line's function, which repeats them in each call, to the setup; only read there."""
    calls = file.calls("declare_parameter")
    function = next(
        (file.function_around(each) for each in calls if each.lineno <= line <= (each.end_lineno or 0)), None
    )
    repeated = [each for each in calls if function is not None and file.function_around(each) is function]
    if function is None or function is file.setup:
        return []
    elsewhere = {ast.unparse(each.args[0]) for each in calls if each not in repeated and each.args}
    bare = [file.statement(each) for each in repeated if isinstance(file.statement(each), ast.Expr)]
    reads = [
        (each, f"{file.name}.get_parameter({ast.unparse(each.args[0])})")
        for each in repeated
        if each.args and file.statement(each) not in bare
    ]
    missing = [ast.unparse(each) for each in repeated if each.args and ast.unparse(each.args[0]) not in elsewhere]
    return [
        *(remove_statement(file.text, each) for each in bare),
        *replace_nodes(file.text, *reads),
        *(_below_super(file, "\n".join(missing)) if missing else []),
    ]


def _below_super(file: NodeFile, code: str) -> list[Edit]:
    """Insert code right below the creation of the node."""
    for call in file.calls("__init__", "create_node", "Node"):
        statement = file.statement(call)
        if file.function_around(call) is file.setup and not isinstance(statement, ast.ClassDef | ast.FunctionDef):
            return [insert_after(statement, code)]
    return file.append_to_setup(code)


def check_at_start(file: NodeFile, rate: str) -> list[Edit]:
    """Let the node exit if it is started with a bad rate. `rate` is the parameter's name."""
    calls = [each for each in file.calls("declare_parameter", "declare_parameters") if rate in ast.unparse(each)]
    if not calls:
        return []
    statement = file.statement(calls[0])
    code = (
        f"if {file.value(rate)} <= 0.0:\n"
        f"    {file.name}.get_logger().fatal('{rate} must be > 0')\n"
        "    raise SystemExit(1)"
    )
    return [insert_after(statement, code)]


def _default_beside(node: ast.AST, name: str) -> ast.expr | None:
    """The default of a parameter in a tuple, a list, a dict, a call of dict(), or a dataclass."""
    match node:
        case ast.Tuple(elts=[first, second, *_]) | ast.List(elts=[first, second]) if is_text(first, name):
            return second
        case ast.Dict(keys=keys, values=values):
            pairs = [(key, value) for key, value in zip(keys, values, strict=True) if key is not None]
            named = any(is_text(key, "name") and is_text(value, name) for key, value in pairs)
            wanted = ("default", "value", "default_value") if named else (name,)
            return next((value for key, value in pairs if any(is_text(key, each) for each in wanted)), None)
        case ast.AnnAssign(target=ast.Name(id=field), value=ast.Constant() as value) if field == name:
            return value
        case ast.Call(func=ast.Name(id="dict"), keywords=given):
            return next((each.value for each in given if each.arg == name), None)
    return None


def is_text(node: ast.expr | None, text: str) -> bool:
    """Whether this is the given string."""
    return isinstance(node, ast.Constant) and node.value == text


def reads(node: ast.AST, name: str) -> bool:
    """Whether this is `node.get_parameter(name).value`, or an equivalent expression."""
    if not isinstance(node, ast.Attribute) or not node.attr.endswith("value"):
        return False
    inner: ast.expr = node.value
    while isinstance(inner, ast.Attribute | ast.Call):
        if isinstance(inner, ast.Call) and isinstance(inner.func, ast.Attribute) and inner.func.attr in _READ_CALLS:
            return is_text(argument(inner, 0, "name"), name)
        inner = inner.func if isinstance(inner, ast.Call) else inner.value
    return False


def readings(file: NodeFile, name: str) -> list[ast.expr]:
    """The expressions that read a parameter's value from the node."""
    return [each for each in ast.walk(file.tree) if isinstance(each, ast.expr) and reads(each, name)]


def find_kept_value(file: NodeFile, name: str) -> ast.Assign | ast.AnnAssign | None:
    """The first assignment that stores a parameter's value, or something computed from it."""
    for node in ast.walk(file.tree):
        if (
            isinstance(node, ast.Assign | ast.AnnAssign)
            and node.value is not None
            and any(reads(each, name) for each in ast.walk(node.value))
        ):
            return node
    return None
