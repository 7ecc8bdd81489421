"""Mistakes that raise no exception, found in the learner's source, with the step that fixes them."""

from __future__ import annotations

import ast

from tutor.judge import edits, source
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.trace import Level, Trace
from tutor.judge.verdict import Cause

_LEVELS = {"WARN": Level.WARN, "WARNING": Level.WARN, "ERROR": Level.ERROR, "FATAL": Level.FATAL}
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
        found = [each for each in nodes if isinstance(each, ast.Constant) and each.value is True]
        if found or isinstance(around, ast.stmt):
            return next(iter(found), None)
    return None


def diagnose_other_domain(file: NodeFile) -> Cause | None:
    """Whether the program chooses a domain of its own, where nobody sees its node."""
    for node in file.nodes:
        match node:
            case ast.Assign(targets=[ast.Subscript(slice=ast.Constant(value="ROS_DOMAIN_ID"))]):
                edit = edits.remove_statement(file.text, node)
            case ast.Call(keywords=keywords) if any(each.arg == "domain_id" for each in keywords):
                kept = [each for each in keywords if each.arg != "domain_id"]
                edit = edits.replace_node(file.text, node, ast.unparse(ast.Call(node.func, node.args, kept)))
            case _:
                continue
        if (step := file.step([edit])) is not None:
            text = f"{source.where(node)} puts the node into another domain, where nothing else sees it"
            return Cause("another domain", text, step)
    return None


def diagnose_raised_level(file: NodeFile, lowest: int) -> Cause | None:
    """Whether the program raises a logger's level, so that messages below it are left out.

    `lowest`: the lowest level (see `Level`) of the messages that were logged.
    """
    for call in file.calls("set_level", "set_logger_level"):
        given = [*call.args, *(each.value for each in call.keywords)]
        level = _LEVELS.get(source.last_name(given[-1])) if given else None
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
