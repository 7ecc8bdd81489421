"""Mistakes that raise no exception, found in the learner's source, with the step that fixes them."""

from __future__ import annotations

import ast
import contextlib
import io
import re
import tokenize
from collections.abc import Iterable

from tutor.judge import edits, source
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.trace import Level, Trace
from tutor.judge.verdict import Cause

_LEVELS = {"WARN": Level.WARN, "WARNING": Level.WARN, "ERROR": Level.ERROR, "FATAL": Level.FATAL}
_EXITS = ("exit", "_exit", "quit")
_TRUTH_VALUES = {"true": True, "1": True, "on": True, "false": False, "0": False, "off": False}


def fix_bool_compared_with_text(trace: Trace) -> str | None:
    """The step for a parameter value (True or False) that is compared with a text such as 'true'; None if none is."""
    text = trace.sources.get(trace.file, "")
    for node in source.syntax_nodes(text):
        match node:
            case ast.Compare(left=left, ops=[ast.Eq() | ast.NotEq() as operator], comparators=[right]):
                pass
            case _:
                continue
        compared, literal = (left, right) if isinstance(right, ast.Constant) else (right, left)
        if not (isinstance(literal, ast.Constant) and isinstance(literal.value, str)):
            continue
        truth, value = _TRUTH_VALUES.get(literal.value.lower()), _parameter_value(compared)
        if truth is None or value is None:
            continue
        negation = "" if truth is isinstance(operator, ast.Eq) else "not "
        return edits.describe_edits(text, edits.replace_node(text, node, f"{negation}{ast.unparse(value)}"))
    return None


def diagnose_simulated_time(file: NodeFile) -> Cause | None:
    """Whether the node sets use_sim_time, so that its timers wait for a simulator's clock."""
    for name in (each for each in file.nodes if isinstance(each, ast.Constant) and each.value == "use_sim_time"):
        value = _true_beside(file, name)
        step = file.step([edits.replace_node(file.text, value, "False")]) if value is not None else None
        if step is not None:
            text = f"line {name.lineno}: with use_sim_time, timers wait for a simulator's /clock, and there is none"
            return Cause("simulated time", text, step)
    return None


def _true_beside(file: NodeFile, name: ast.Constant) -> ast.expr | None:
    """The True given together with a name: its value in a dict, or in the innermost expression that has one."""
    for around in file.ancestors(name):
        match around:
            case ast.Dict(keys=keys, values=values) if name in keys:
                nodes: list[ast.AST] = [values[keys.index(name)]]
            case _:
                nodes = list(ast.walk(around))
        found = [each for each in nodes if isinstance(each, ast.expr) and _is_true(file, each)]
        if found or isinstance(around, ast.stmt):
            return next(iter(found), None)
    return None


def _is_true(file: NodeFile, value: ast.expr) -> bool:
    """Whether this is True, or a constant that is True."""
    if isinstance(value, ast.Name):
        given = source.values_of(value.id, file.tree)
        return len(given) == 1 and isinstance(given[0], ast.Constant) and given[0].value is True
    return isinstance(value, ast.Constant) and value.value is True


def diagnose_xor(file: NodeFile) -> Cause | None:
    """Whether the file writes ^ for a power of 2 or 10, as in 10^9."""
    for node in file.nodes:
        if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.BitXor):
            continue
        base = node.left.right if isinstance(node.left, ast.BinOp) else node.left  # x / 10^9 is (x / 10) ^ 9
        power = node.right.left if isinstance(node.right, ast.BinOp) else node.right
        match base, power:
            case ast.Constant(value=int() as number), ast.Constant(value=int() as exponent) if number in (2, 10):
                pattern = rf"\b{number}\s*\^\s*{exponent}\b"
                step = file.step(edits.replace_pattern(file.text, pattern, f"{number}**{exponent}"))
                text = f"line {node.lineno}: {number}^{exponent} is {number ^ exponent}: ^ is a bitwise XOR, ** a power"
                return Cause("^ is no power", text, step) if step else None
    return None


def diagnose_never_none(file: NodeFile) -> Cause | None:
    """Whether an attribute is compared with None to set it for the first time, but never is None: it begins as 0."""
    for test in file.nodes:
        match test:
            case ast.If(
                test=ast.Compare(left=ast.Attribute() as left, ops=[ast.Is()], comparators=[ast.Constant(None)])
            ):
                pass
            case _:
                continue
        given = source.values_of(name := ast.unparse(left), file.tree)
        within = [each for statement in test.body for each in ast.walk(statement)]
        initial = [each for each in given if each not in within]
        is_set = any(isinstance(each, ast.Assign) and name in map(ast.unparse, each.targets) for each in within)
        value = initial[0] if is_set and len(initial) == 1 else None
        if not isinstance(value, ast.Constant) or value.value is None:
            continue
        if (step := file.step([edits.replace_node(file.text, value, "None")])) is not None:
            text = f"{name} is never None (line {test.lineno}): it begins as {ast.unparse(value)} (line {value.lineno})"
            return Cause("never None", text, step)
    return None


def diagnose_missing_f(file: NodeFile, texts: Iterable[str]) -> Cause | None:
    """Whether a placeholder stands in a logged text as it is, since the string in the file has no f in front."""
    lines, seen = file.text.splitlines(), "\n".join(texts)
    with contextlib.suppress(tokenize.TokenError, SyntaxError):
        for token in tokenize.generate_tokens(io.StringIO(file.text).readline):
            if token.type != tokenize.STRING or token.string[0].lower() in "bu":
                continue
            placeholders = re.findall(r"\{[A-Za-z_][^{}\n]*\}", token.string)
            if any(each in seen for each in placeholders):
                row, column = token.start
                code = f"{lines[row - 1][:column]}f{lines[row - 1][column:]}".strip()
                if (step := file.step([edits.replace_lines(row, code)])) is not None:
                    text = f"line {row}: {token.string} is logged as it is, with {placeholders[0]}, and not the value"
                    return Cause("no f in front of the text", text, step)
    return None


def diagnose_main_guard(file: NodeFile) -> Cause | None:
    """Whether the program compares `__name__` with another text than "__main__", and so calls nothing."""
    for node in file.nodes:
        match node:
            case ast.If(
                test=ast.Compare(left=ast.Name("__name__"), comparators=[ast.Constant(value=str() as text) as compared])
            ) if text != "__main__":
                step = file.step([edits.replace_node(file.text, compared, "'__main__'")])
                if step is not None:
                    return Cause("no main call", f"line {node.lineno}: __name__ is never {text!r}", step)
    return None


def diagnose_argument_guard(file: NodeFile) -> Cause | None:
    """Whether the program ends by itself because of the number of its arguments, which it does not use at all."""
    subscripts = [ast.unparse(each) for each in file.nodes if isinstance(each, ast.Subscript)]
    used = [each for each in subscripts if each.startswith("sys.argv[") and each != "sys.argv[0]"]
    for each in file.nodes:
        if not isinstance(each, ast.If) or each.orelse or used or "len(sys.argv)" not in ast.unparse(each.test):
            continue
        ends = isinstance(each.body[-1], ast.Raise | ast.Return) or source.calls_in(each.body[-1], *_EXITS)
        step = file.step([edits.remove_statement(file.text, each)]) if ends else None
        if step is not None:
            text = (
                f"line {each.lineno}: if {ast.unparse(each.test)}: ROS passes arguments of its own, such as parameters"
            )
            return Cause("arguments refused", text, step)
    return None


def diagnose_shared_object(file: NodeFile) -> Cause | None:
    """Whether two variables are given one and the same dict, list or other object: `first = last = {}`."""
    for node in file.nodes:
        if (
            isinstance(node, ast.Assign)
            and len(node.targets) > 1
            and isinstance(node.value, ast.Dict | ast.List | ast.Set | ast.Call)
        ):
            targets = [ast.unparse(each) for each in node.targets]
            code = "\n".join(f"{target} = {ast.unparse(node.value)}" for target in targets)
            if (step := file.step([edits.replace_statement(node, code)])) is not None:
                text = f"line {node.lineno}: {' and '.join(targets)} are one object: a change of one changes the other"
                return Cause("one object, two names", text, step)
    return None


def diagnose_other_domain(file: NodeFile) -> Cause | None:
    """Whether the program chooses a domain of its own, where nobody sees its node."""
    for node in file.nodes:
        match node:
            case ast.Assign(targets=[ast.Subscript(slice=ast.Constant(value="ROS_DOMAIN_ID"))]):
                edit = edits.remove_statement(file.text, node)
            case ast.Call(keywords=keywords) if any(each.arg == "domain_id" for each in keywords):
                edit = edits.remove_keyword(file.text, node, "domain_id")
            case _:
                continue
        if (step := file.step([edit])) is not None:
            text = f"{source.where(node)} puts the node into another domain, where nothing else sees it"
            return Cause("another domain", text, step)
    return None


def diagnose_bare_topic_names(file: NodeFile) -> Cause | None:
    """Whether a QoS profile has DDS use topic names as they are, so that ROS nodes do not find each other."""
    for node in ast.walk(file.tree):
        match node:
            case ast.keyword(arg=str(name), value=ast.Constant(value=True) as value):
                pass
            case ast.Assign(targets=[ast.Attribute(attr=name)], value=ast.Constant(value=True) as value):
                pass
            case _:
                continue
        if name != "avoid_ros_namespace_conventions":
            continue
        step = file.step([edits.replace_node(file.text, value, "False")])
        if step is not None:
            text = f"{name} leaves out the prefix that ROS gives to topics in DDS: no other ROS node finds this one"
            return Cause("not a ROS topic", text, step)
    return None


def diagnose_raised_level(file: NodeFile, lowest: int) -> Cause | None:
    """Whether the program raises a logger's level, so that messages below it are left out.

    `lowest`: the lowest level (see `Level`) of the messages that were logged; a level that is computed is raised if
    there were none at all.
    """
    for call in file.calls("set_level", "set_logger_level"):
        given = [*call.args, *(each.value for each in call.keywords)]
        level = _LEVELS.get(source.last_name(given[-1])) if given else None
        if level is None and given and isinstance(given[-1], ast.Name) and lowest == Level.FATAL:
            level = Level.FATAL
        statement = file.statement(call)
        if level is None or lowest < level or not isinstance(statement, ast.Expr):
            continue
        if (step := file.step([edits.remove_statement(file.text, statement)])) is not None:
            text = f"line {call.lineno}: {ast.unparse(call)} leaves out what is logged below that level"
            return Cause("log level raised", text, step)
    return None


def _parameter_value(expression: ast.expr) -> ast.expr | None:
    """The `x.value` in `x.value` or `str(x.value)`. `str(x.value).lower()` is not matched: comparing it is correct."""
    match expression:
        case ast.Call(func=ast.Name(id="str"), args=[inner]):
            return _parameter_value(inner)
        case ast.Attribute(attr="value" | "bool_value"):
            return expression
    return None
