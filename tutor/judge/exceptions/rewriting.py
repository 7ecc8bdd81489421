"""Edits of known exceptions that need the file's syntax tree, or a search: `{ rewritten = NAME }` in the tables."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from typing import TypeGuard

from tutor.judge import edits
from tutor.judge.edits import Edit
from tutor.judge.exceptions.callback_rewriting import (
    done_callbacks,
    instances,
    methods,
    own_executors,
    raised,
    responses,
    service_parameters,
    timer_parameters,
)
from tutor.judge.exceptions.log_rewriting import log, logged_less, receiver, rospy_logs, severities
from tutor.judge.exceptions.message_rewriting import fields, message_types, types_first
from tutor.judge.known_exception import Words
from tutor.judge.rewriting.syntax import repair
from tutor.judge.source import SourceFile, called_name, last_name, syntax_nodes

_SETUP = re.compile(r"super\(.*\)\.__init__\(|Node\.__init__\(")
"""A statement that sets rclpy's Node up."""


def imported(text: str, words: Words) -> Sequence[Edit] | None:
    """Import a name from the module that has it, and correct its spelling wherever it is used."""
    statement = SourceFile(text).statement_at(int(words["number"]))
    if not isinstance(statement, ast.ImportFrom):
        return None
    name, correct = words["name"], words.get("nearest") or words["name"]
    alias = next((each for each in statement.names if each.name == name), None)
    if alias is None:
        return None
    uses = [each for each in syntax_nodes(text) if isinstance(each, ast.Name) and each.id == name and correct != name]
    swaps = [] if alias.asname else edits.replace_nodes(text, *((each, correct) for each in uses))
    return [edits.replace_imports(statement, [(alias, words["found"])]), *swaps]


def without(text: str, words: Words) -> Sequence[Edit] | None:
    """Remove a statement, and the statements that only use what it assigns."""
    statement = SourceFile(text).statement_at(int(words["number"]))
    if statement is None:
        return None
    target = ast.unparse(statement.targets[0]) if isinstance(statement, ast.Assign) else ""
    uses = [each for each in syntax_nodes(text) if target and isinstance(each, ast.Expr) and _uses(each, target)]
    return [edits.remove_statement(text, each) for each in (statement, *uses)]


def _uses(statement: ast.stmt, target: str) -> bool:
    nodes = ast.walk(statement)
    return any(isinstance(each, ast.Attribute | ast.Name) and ast.unparse(each) == target for each in nodes)


def before_destroying(text: str, words: Words) -> Sequence[Edit] | None:
    """Move a statement, or the call of the function that contains it, above what destroys the node or entity."""
    file = SourceFile(text)
    statement = file.statement_at(int(words["number"]))
    function = file.function_at(statement.lineno) if statement is not None else None
    calls = [
        each for each in file.nodes if function and isinstance(each, ast.Call) and called_name(each) == function.name
    ]
    for moved in filter(None, [statement, *map(file.statement, calls)]):
        block = file.block_of(moved)
        before = [each for each in block[: block.index(moved)] if _destroys(each)] if block else []
        if before and isinstance(moved, ast.Expr):
            code = textwrap.dedent("\n".join(text.splitlines()[moved.lineno - 1 : moved.end_lineno]))
            return [edits.remove_statement(text, moved), edits.insert_above(before[0].lineno, code)]
    return None


def node_first(text: str, words: Words) -> Sequence[Edit] | None:
    """Set rclpy's Node up, by `super().__init__`, above the first statement that uses it in the same constructor."""
    for function in SourceFile(text).functions_named("__init__"):
        first = next((each for each in function.body if _uses_self(each)), None)
        if first is not None and "__init__(" not in ast.unparse(first):
            for each in function.body:
                if isinstance(each, ast.Expr) and _SETUP.match(code := ast.unparse(each)):
                    return [edits.insert_above(first.lineno, code), edits.remove_statement(text, each)]
    return None


def _uses_self(statement: ast.stmt) -> bool:
    """Whether a statement calls a method of `self`, or of the parent class."""
    calls = [ast.unparse(each.func) for each in ast.walk(statement) if isinstance(each, ast.Call)]
    return any(re.match(r"self\.|super\(|Node\.__init__", each) for each in calls)


def shutdown_at_end(text: str, words: Words) -> Sequence[Edit] | None:
    """Move the shutdown from a function that is called repeatedly to the end of the block that calls it last."""
    file = SourceFile(text)
    function = next(iter(file.functions_named(words["function"])), None)
    ends = [
        each
        for each in (ast.walk(function) if function is not None else ())
        if isinstance(each, ast.Expr)
        and isinstance(each.value, ast.Call)
        and called_name(each.value) in ("shutdown", "try_shutdown")
    ]
    calls = [each for each in file.nodes if isinstance(each, ast.Call) and called_name(each) == words["function"]]
    last = max((file.statement(each) for each in calls), key=lambda each: each.lineno, default=None)
    block = file.block_of(last) if last is not None else []
    if not ends or not block:
        return None
    return [edits.insert_after(block[-1], ast.unparse(ends[0])), *(edits.remove_statement(text, each) for each in ends)]


def _destroys(statement: ast.stmt) -> bool:
    calls = [each for each in ast.walk(statement) if isinstance(each, ast.Call)]
    return any(called_name(each).startswith("destroy") for each in calls)


def optional(text: str, words: Words) -> Sequence[Edit]:
    """Make every command line argument optional, and ignore those of ROS."""
    swaps: list[tuple[ast.expr, str]] = []
    for call in syntax_nodes(text):
        if isinstance(call, ast.Call) and called_name(call) == "parse_args":
            swaps.append((call, f"{ast.unparse(call).replace('.parse_args(', '.parse_known_args(')}[0]"))
        if isinstance(call, ast.Call) and called_name(call) == "add_argument" and call.args:
            names = [ast.unparse(each) for each in call.args]
            kept = [each for each in call.keywords if each.arg != "required"]
            if not (positional := names[0][1:2] != "-") and len(kept) == len(call.keywords):
                continue
            if positional:
                names = [f"{names[0][0]}--{names[0][1:]}"]
            given = [f"{each.arg}={ast.unparse(each.value)}" for each in kept]
            is_text = any(each.arg == "type" and ast.unparse(each.value) == "str" for each in kept)
            given += [] if any(each.arg == "default" for each in kept) else [f"default={'one' if is_text else '1'!r}"]
            swaps.append((call, f"{ast.unparse(call.func)}({', '.join([*names, *given])})"))
    return edits.replace_nodes(text, *swaps)


def items(text: str, words: Words) -> Sequence[Edit]:
    """Give `launch_arguments` the items of each dict that is passed whole."""
    given = [
        each.value
        for node in syntax_nodes(text)
        if isinstance(node, ast.Call)
        for each in node.keywords
        if each.arg == "launch_arguments" and isinstance(each.value, ast.Name | ast.Attribute | ast.Dict)
    ]
    return edits.replace_nodes(text, *((each, f"{ast.unparse(each)}.items()") for each in given))


def rclcpp(text: str, words: Words) -> Sequence[Edit]:
    """Replace what only rclcpp has: create_wall_timer, with a period in milliseconds, and create_callback_group."""
    swaps: list[tuple[ast.expr, str]] = []
    for call in (each for each in syntax_nodes(text) if isinstance(each, ast.Call) and each.args):
        first = call.args[0]
        if called_name(call) == "create_callback_group" and last_name(first).endswith("CallbackGroup"):
            swaps.append((call, f"{ast.unparse(first)}()"))
        elif called_name(call) == "create_wall_timer":
            if isinstance(first, ast.Constant) and isinstance(first.value, int | float) and first.value >= 10:
                first = ast.Constant(first.value / 1000)
            given = ", ".join(map(ast.unparse, [first, *call.args[1:], *call.keywords]))
            swaps.append((call, f"{receiver(call)}.create_timer({given})"))
    return edits.replace_nodes(text, *swaps)


def seconds(text: str, words: Words) -> Sequence[Edit]:
    """Convert the difference of two times to seconds: where it is assigned, else where the line computes it."""
    file = SourceFile(text)
    statement = file.statement_at(int(words["number"]))
    types = re.search(r"'(\w+)' and '(\w+)'", words["raised"])
    durations = [
        operand
        for each in (ast.walk(statement) if statement is not None else ())
        for operand, name in zip(_operands(each), types.groups() if types else (), strict=False)
        if name == "Duration"
    ]
    used = {ast.unparse(each) for each in durations}
    swaps: list[tuple[ast.expr, str]] = [
        (assigned.value, f"({ast.unparse(assigned.value)}).nanoseconds / 1e9")
        for assigned in file.nodes
        if isinstance(assigned, ast.Assign) and _is_difference(assigned.value)
        if (target := ast.unparse(assigned.targets[0])) in used and f"{target}.nanoseconds" not in text
    ]
    if not swaps:
        swaps = [(each, f"({ast.unparse(each)}).nanoseconds / 1e9") for each in durations if _is_difference(each)]
    return edits.replace_nodes(text, *swaps)


def _operands(node: ast.AST) -> tuple[ast.expr, ...]:
    """The left and right operand of an operator or of a comparison."""
    match node:
        case ast.BinOp(left=left, right=right) | ast.Compare(left=left, comparators=[right]):
            return left, right
        case ast.AugAssign(target=left, value=right):
            return left, right
    return ()


def _is_difference(node: ast.AST) -> TypeGuard[ast.BinOp]:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub)


def utf8(text: str, words: Words) -> Sequence[Edit]:
    """Add the encoding to the first call in a statement that opens a file without one."""
    statement = SourceFile(text).statement_at(int(words["number"]))
    swaps: list[tuple[ast.expr, str]] = []
    for call in ast.walk(statement) if statement is not None else ():
        if not isinstance(call, ast.Call) or called_name(call) not in ("open", "read_text", "write_text"):
            continue
        if not any(each.arg == "encoding" for each in call.keywords):
            code = ast.get_source_segment(text, call) or ast.unparse(call)
            comma = ", " if call.args or call.keywords else ""
            swaps.append((call, f"{code[:-1].rstrip().rstrip(',')}{comma}encoding='utf-8')"))
    return edits.replace_nodes(text, *swaps[:1])


def decoded(text: str, words: Words) -> Sequence[Edit] | None:
    """Let subscriptions pass on messages, not their bytes."""
    calls = SourceFile(text).calls("create_subscription")
    raw = [each for each in calls if any(keyword.arg == "raw" for keyword in each.keywords)]
    return [edits.remove_keyword(text, each, "raw") for each in raw]


def readable(text: str, words: Words) -> Sequence[Edit] | None:
    """Repair the file's syntax by the smallest change after which Python can read it."""
    return repair(text)


_REWRITERS = (
    *(log, logged_less, rospy_logs, severities, imported, types_first, readable, without, raised, decoded),
    *(
        responses,
        instances,
        service_parameters,
        timer_parameters,
        before_destroying,
        node_first,
        shutdown_at_end,
        optional,
        items,
        done_callbacks,
        own_executors,
        methods,
        rclcpp,
        fields,
        message_types,
        seconds,
        utf8,
    ),
)
REWRITERS: Mapping[str, Callable[[str, Words], Sequence[Edit] | None]] = {each.__name__: each for each in _REWRITERS}
"""The edits by their names in the tables; each takes the file's text and the placeholders' values."""
