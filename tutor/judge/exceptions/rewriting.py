"""Edits of known exceptions that need the file's syntax tree, or a search: `{ rewritten = NAME }` in the tables."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence

from tutor.judge import edits
from tutor.judge.edits import Edit
from tutor.judge.rewriting.syntax import repair
from tutor.judge.source import Function, SourceFile, called_name, last_name, syntax_nodes, values_of

Words = Mapping[str, str]

_LEVELS = ("debug", "info", "warn", "warning", "error", "fatal")
_PLACEHOLDER = re.compile(r"%[-+ #0-9.]*[sdifrgxe]")


def log(text: str, words: Words) -> Sequence[Edit]:
    """Format the message of log calls that pass values after it, as Python's logging takes them and rclpy does not."""
    statement = SourceFile(text).statement_at(int(words["number"]))
    if statement is None:
        return []
    calls = [each for each in syntax_nodes(text) if isinstance(each, ast.Call) and called_name(each) in _LEVELS]
    calls = [each for each in calls if len(each.args) > 1 and isinstance(each.func, ast.Attribute)]
    loggers = {_receiver(each) for each in calls if statement.lineno <= each.lineno <= (statement.end_lineno or 0)}
    found = [each for each in calls if _receiver(each) in loggers or _receiver(each).endswith("get_logger()")]
    return edits.replace_nodes(text, *((each, _format_message(text, each)) for each in found))


def _receiver(call: ast.Call) -> str:
    return ast.unparse(call.func.value) if isinstance(call.func, ast.Attribute) else ""


def _format_message(text: str, call: ast.Call) -> str:
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


def types_first(text: str, words: Words) -> Sequence[Edit]:
    """Swap type and name in each call that creates a publisher, subscription, service or client with the name first."""
    swaps: list[tuple[ast.expr, str]] = []
    for call in syntax_nodes(text):
        if not isinstance(call, ast.Call) or not re.fullmatch(r"create_(?!timer|rate)\w+", called_name(call)):
            continue
        name, kind = (*call.args, None, None)[:2]
        last = ast.unparse(kind).rpartition(".")[2] if isinstance(kind, ast.Name | ast.Attribute) else ""
        first = ast.unparse(name).rpartition(".")[2] if name is not None else ""
        if name is None or kind is None or not _looks_like_type(last) or _looks_like_type(first):
            continue
        swaps += [(name, ast.unparse(kind)), (kind, ast.unparse(name))]
    return edits.replace_nodes(text, *swaps)


def _looks_like_type(name: str) -> bool:
    return name[:1].isupper() and not name.isupper()


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


def raised(text: str, words: Words) -> Sequence[Edit] | None:
    """Log an error instead of raising it in a callback; an on-set parameter callback refuses the change with it."""
    statement = SourceFile(text).statement_at(int(words["number"]))
    function = SourceFile(text).function_at(statement.lineno) if statement is not None else None
    if not isinstance(statement, ast.Raise) or statement.exc is None or function is None:
        return None
    error = statement.exc.args[0] if isinstance(statement.exc, ast.Call) and statement.exc.args else statement.exc
    reason = ast.unparse(error) if isinstance(error, ast.Constant | ast.JoinedStr) else f"str({ast.unparse(error)})"
    end = statement.end_lineno or statement.lineno
    for checker in _callbacks(text, "add_on_set_parameters_callback"):
        if checker.name == function.name:
            code = f"return SetParametersResult(successful=False, reason={reason})"
            return [*_import_result(text), edits.replace_lines(statement.lineno, code, end)]
        calls = [
            each for each in ast.walk(checker) if isinstance(each, ast.Call) and called_name(each) == function.name
        ]
        if calls:
            return [*_import_result(text), _refuse_on_error(text, SourceFile(text).statement_at(calls[0].lineno))]
    if not function.args.args or function.args.args[0].arg != "self" or function.name == "__init__":
        return None
    services = [each for each in _callbacks(text, "create_service") if each.name == function.name]
    return_line = f"return {services[0].args.args[-1].arg}" if services else "return"
    return [edits.replace_lines(statement.lineno, f"self.get_logger().error({reason})\n{return_line}", end)]


def _import_result(text: str) -> Sequence[Edit]:
    has_import = re.search(r"import .*\bSetParametersResult\b|^\s*SetParametersResult,?\s*$", text, re.MULTILINE)
    return [] if has_import else edits.add_import(text, "from rcl_interfaces.msg import SetParametersResult")


def _refuse_on_error(text: str, statement: ast.stmt | None) -> Edit:
    """Wrap a statement of an on-set callback so that any exception in it refuses the change."""
    assert statement is not None
    end = statement.end_lineno or statement.lineno
    code = textwrap.indent(textwrap.dedent("\n".join(text.splitlines()[statement.lineno - 1 : end])), "    ")
    refuse = "return SetParametersResult(successful=False, reason=str(error))"
    return edits.replace_lines(statement.lineno, f"try:\n{code}\nexcept Exception as error:\n    {refuse}", end)


def _callbacks(text: str, create: str) -> Iterator[Function]:
    """The functions that are passed to calls of `create`."""
    for call in syntax_nodes(text):
        if isinstance(call, ast.Call) and called_name(call) == create:
            for each in (*call.args, *(given.value for given in call.keywords)):
                yield from SourceFile(text).functions_named(last_name(each))[-1:]


def responses(text: str, words: Words) -> Sequence[Edit] | None:
    """Make every service callback that returns nothing return its response, and so the function `callback`."""
    found = {each.lineno: each for each in _callbacks(text, "create_service")}
    found |= {each.lineno: each for each in SourceFile(text).functions_named(words["callback"])[-1:]}
    made: list[Edit] = []
    for function in found.values():
        names = [each.arg for each in function.args.args if each.arg != "self"]
        if len(names) == 2:
            made += edits.return_on_every_path(function, names[1])
    return sorted(made, key=lambda edit: -edit.first)


def instances(text: str, words: Words) -> Sequence[Edit]:
    """Make instances of a service's Response where the class itself is returned, or filled and returned."""
    nodes = syntax_nodes(text)
    returned = {ast.unparse(each.value) for each in nodes if isinstance(each, ast.Return) and each.value}
    classes = [
        each.value
        for each in nodes
        if isinstance(each, ast.Assign | ast.Return)
        and isinstance(each.value, ast.Attribute)
        and each.value.attr == "Response"
        and (isinstance(each, ast.Return) or returned.intersection(map(ast.unparse, each.targets)))
    ]
    return edits.replace_nodes(text, *((each, f"{ast.unparse(each)}()") for each in classes))


def service_parameters(text: str, words: Words) -> Sequence[Edit]:
    """Give every service callback a request and a response, after `self` if it is a method."""
    file, lines = SourceFile(text), text.splitlines()
    functions = {each.lineno: each for each in _callbacks(text, "create_service")}
    made: list[Edit] = []
    for number in sorted(functions, reverse=True):
        given = [each.arg for each in functions[number].args.args]
        is_method = file.class_of(functions[number]) is not None and not functions[number].decorator_list
        own = [each for each in given if each != "self"]
        wanted = [*(["self"] if is_method else []), *(own[:1] or ["request"]), *(own[1:2] or ["response"])]
        line = lines[number - 1].strip()
        head = re.sub(r"\([^()]*\)", f"({', '.join(wanted)})", line, count=1)
        if given != wanted and head != line:
            made.append(edits.replace_lines(number, head))
    return made


def timer_parameters(text: str, words: Words) -> Sequence[Edit]:
    """Let every timer callback take nothing but `self`, if it is a method."""
    lines, made = text.splitlines(), list[Edit]()
    for function in {each.lineno: each for each in _callbacks(text, "create_timer")}.values():
        kept = [each.arg for each in function.args.args if each.arg == "self"]
        head = re.sub(r"\([^()]*\)", f"({', '.join(kept)})", lines[function.lineno - 1].strip(), count=1)
        if len(function.args.args) > len(function.args.defaults) + len(kept):
            made.append(edits.replace_lines(function.lineno, head))
    return sorted(made, key=lambda edit: -edit.first)


def before_destroying(text: str, words: Words) -> Sequence[Edit] | None:
    """Move a statement, or the call of the function that contains it, above what destroys the node or entity."""
    file = SourceFile(text)
    statement = file.statement_at(int(words["number"]))
    function = file.function_at(statement.lineno) if statement is not None else None
    calls = [
        each for each in file.nodes if function and isinstance(each, ast.Call) and called_name(each) == function.name
    ]
    for moved in filter(None, [statement, *map(file.statement, calls)]):
        block = next((each for each in _blocks(file.tree) if moved in each), [])
        before = [each for each in block[: block.index(moved)] if _destroys(each)] if moved in block else []
        if before and isinstance(moved, ast.Expr):
            code = textwrap.dedent("\n".join(text.splitlines()[moved.lineno - 1 : moved.end_lineno]))
            return [edits.remove_statement(text, moved), edits.insert_above(before[0].lineno, code)]
    return None


def _blocks(tree: ast.AST) -> Iterator[list[ast.stmt]]:
    for node in ast.walk(tree):
        for name in ("body", "orelse", "finalbody"):
            if isinstance(block := getattr(node, name, None), list):
                yield block


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
            given += [] if any(each.arg == "default" for each in kept) else ["default='1'"]
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


def methods(text: str, words: Words) -> Sequence[Edit]:
    """Turn static methods that take `self` into ordinary ones."""
    found = [
        decorator.lineno
        for function in SourceFile(text).functions
        if [each.arg for each in function.args.args[:1]] == ["self"]
        for decorator in function.decorator_list
        if ast.unparse(decorator) == "staticmethod"
    ]
    return [edits.remove_lines(text, number, number) for number in reversed(found)]


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
            swaps.append((call, f"{_receiver(call)}.create_timer({given})"))
    return edits.replace_nodes(text, *swaps)


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


def readable(text: str, words: Words) -> Sequence[Edit] | None:
    """Repair the file's syntax by the smallest change after which Python can read it."""
    return repair(text)


_REWRITERS = (
    *(log, logged_less, severities, imported, types_first, readable, without, raised),
    *(
        responses,
        instances,
        service_parameters,
        timer_parameters,
        before_destroying,
        optional,
        items,
        methods,
        rclcpp,
        utf8,
    ),
)
REWRITERS: Mapping[str, Callable[[str, Words], Sequence[Edit] | None]] = {each.__name__: each for each in _REWRITERS}
"""The edits by their names in the tables; each takes the file's text and the placeholders' values."""
