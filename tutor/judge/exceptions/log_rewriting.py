"""Edits of known exceptions that concern log calls."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping, Sequence

from tutor.judge import edits
from tutor.judge.edits import Edit
from tutor.judge.known_exception import Words
from tutor.judge.source import SourceFile, called_name, syntax_nodes, values_of

_LEVELS = ("debug", "info", "warn", "warning", "error", "fatal")
_ROSPY_LOGS = {"logdebug": "debug", "loginfo": "info", "logwarn": "warning", "logerr": "error", "logfatal": "fatal"}
_PLACEHOLDER = re.compile(r"%[-+ #0-9.]*[sdifrgxe]")


def log(text: str, words: Words) -> Sequence[Edit]:
    """Format the message of log calls that pass values after it, as Python's logging takes them and rclpy does not."""
    statement = SourceFile(text).statement_at(int(words["number"]))
    if statement is None:
        return []
    calls = [each for each in syntax_nodes(text) if isinstance(each, ast.Call) and called_name(each) in _LEVELS]
    calls = [each for each in calls if len(each.args) > 1 and isinstance(each.func, ast.Attribute)]
    loggers = {receiver(each) for each in calls if statement.lineno <= each.lineno <= (statement.end_lineno or 0)}
    found = [each for each in calls if receiver(each) in loggers or receiver(each).endswith("get_logger()")]
    return edits.replace_nodes(text, *((each, _format_message(text, each)) for each in found))


def receiver(call: ast.Call) -> str:
    """The expression whose method is called."""
    return ast.unparse(call.func.value) if isinstance(call.func, ast.Attribute) else ""


def _format_message(text: str, call: ast.Call) -> str:
    if len(call.args) == 1:
        return ast.unparse(call)
    first, *rest = (ast.get_source_segment(text, each) or ast.unparse(each) for each in call.args)
    template = call.args[0].value if isinstance(call.args[0], ast.Constant) else ""
    starred = any(isinstance(each, ast.Starred) for each in call.args)
    plain = len(rest) == 1 and isinstance(call.args[1], ast.Name | ast.Attribute | ast.Constant)
    if isinstance(template, str) and not starred and len(_PLACEHOLDER.findall(template)) == len(rest):
        message = f"{first} % " + (rest[0] if plain else f"({', '.join(rest)}{',' * (len(rest) == 1)})")
    elif isinstance(template, str) and not starred and template.count("{") == len(rest):
        message = f"{first}.format({', '.join(rest)})"
    else:
        message = f"' '.join(map(str, ({', '.join([first, *rest])})))"
    keywords = "".join(f", {ast.unparse(each)}" for each in call.keywords)
    return f"{ast.unparse(call.func)}({message}{keywords})"


def logged_less(text: str, words: Words) -> Sequence[Edit]:
    """Replace log methods of ROS 1, such as `warn_throttle(period, message)`, by the argument that rclpy has for it."""
    swaps: list[tuple[ast.expr, str]] = []
    for call in syntax_nodes(text):
        if not isinstance(call, ast.Call) or not isinstance(call.func, ast.Attribute):
            continue
        level, _, how = call.func.attr.partition("_")
        given = [ast.unparse(each) for each in (*call.args, *call.keywords)]
        match how, given:
            case "throttle", [period, message, *_]:
                new = f"{message}, throttle_duration_sec={period}"
            case "once", [message, *_]:
                new = f"{message}, once=True"
            case "skip_first" | "skipfirst", [message, *_]:
                new = f"{message}, skip_first=True"
            case _:
                continue
        if level in _LEVELS:
            swaps.append((call, f"{ast.unparse(call.func.value)}.{level}({new})"))
    return edits.replace_nodes(text, *swaps)


def rospy_logs(text: str, words: Words) -> Sequence[Edit]:
    """Log with the node's logger wherever a function of rospy logs."""
    swaps: list[tuple[ast.expr, str]] = []
    loggers = [
        ast.unparse(each.targets[0])
        for each in syntax_nodes(text)
        if isinstance(each, ast.Assign) and isinstance(each.value, ast.Call) and called_name(each.value) == "get_logger"
    ]
    for call in syntax_nodes(text):
        match call:
            case ast.Call(func=ast.Attribute(value=ast.Name("rospy"), attr=name), args=[_, *_]) if name in _ROSPY_LOGS:
                function = SourceFile(text).function_at(call.lineno)
                given = [each.arg for each in function.args.args[:1]] if function is not None else []
                logger = next(iter(loggers), f"{'self' if given == ['self'] else 'node'}.get_logger()")
                _, _, arguments = _format_message(text, call).partition("(")
                swaps.append((call, f"{logger}.{_ROSPY_LOGS[name]}({arguments}"))
    return edits.replace_nodes(text, *swaps)


def severities(text: str, words: Words) -> Sequence[Edit] | None:
    """Give each severity a log call of its own, in a statement whose only call logs with several.

    The severity may be given by its name (`getattr(logger, level)(...)`) or its number (`logger.log(..., level)`), or
    the method is chosen (`(logger.info if fine else logger.warning)(...)`), there or in the variable that is called.
    """
    file = SourceFile(text)
    statement = file.statement_at(int(words["number"]))
    if not isinstance(statement, ast.Expr) or not isinstance(call := statement.value, ast.Call):
        return None
    function, method = file.function_at(statement.lineno), call.func
    if isinstance(method, ast.Name) and function is not None and len(given := values_of(method.id, function)) == 1:
        method = given[0]
    severity: ast.expr | None = None
    match method:
        case ast.IfExp(test=test, body=body, orelse=other):
            choices = [(ast.unparse(test), ast.unparse(body)), ("", ast.unparse(other))]
        case ast.Call(func=ast.Name(id="getattr"), args=[logger, level, *_]):
            names = {node.value for node in syntax_nodes(text) if isinstance(node, ast.Constant)}
            choices = _choose_by({repr(name): name for name in _LEVELS if name in names}, level, logger)
        case ast.Attribute(attr="log", value=logger) if call.args:
            severity = next((each.value for each in call.keywords if each.arg == "severity"), call.args[-1])
            nodes = [node for node in syntax_nodes(text) if isinstance(node, ast.Attribute)]
            numbers = {ast.unparse(node): node.attr.lower() for node in nodes if node.attr.lower() in _LEVELS}
            choices = _choose_by({each: numbers[each] for each in numbers if "Severity." in each}, severity, logger)
        case _:
            return None
    arguments = _arguments(call, without=severity)
    branches = [
        f"{('elif' if number else 'if') + f' {condition}' if condition else 'else'}:\n    {logs}({arguments})"
        for number, (condition, logs) in enumerate(choices)
    ]
    return [edits.replace_statement(statement, "\n".join(branches))] if len(branches) > 1 else None


def _choose_by(levels: Mapping[str, str], severity: ast.expr, logger: ast.expr) -> list[tuple[str, str]]:
    """Branches as (condition, method), one for each level (as written: its name), the last one for any other level."""
    log, given = ast.unparse(logger), ast.unparse(severity)
    others = [(f"{given} == {written}", f"{log}.{name}") for written, name in levels.items() if name != "info"]
    return [*others, ("", f"{log}.info")]


def _arguments(call: ast.Call, without: ast.expr | None) -> str:
    """The arguments of a call as code, apart from one of them."""
    positional = [ast.unparse(each) for each in call.args if each is not without]
    named = [f"{each.arg}={ast.unparse(each.value)}" for each in call.keywords if each.value is not without]
    return ", ".join([*positional, *named])
