"""Edits of known exceptions that concern callbacks: what they take, return and raise."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Iterator, Sequence

from tutor.judge import edits
from tutor.judge.edits import Edit
from tutor.judge.known_exception import Words
from tutor.judge.source import Function, SourceFile, called_name, last_name, syntax_nodes


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


def service_callbacks(text: str) -> list[Function]:
    """The functions that answer the services."""
    return list(_callbacks(text, "create_service"))


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
    file = SourceFile(text)
    functions = {each.lineno: each for each in _callbacks(text, "create_service")}
    made: list[Edit] = []
    for number in sorted(functions, reverse=True):
        given = [each.arg for each in functions[number].args.args]
        is_method = file.class_of(functions[number]) is not None and not functions[number].decorator_list
        own = [each for each in given if each != "self"]
        wanted = [*(["self"] if is_method else []), *(own[:1] or ["request"]), *(own[1:2] or ["response"])]
        if given != wanted:
            made += edits.replace_parameters(text, functions[number], wanted)
    return made


def timer_parameters(text: str, words: Words) -> Sequence[Edit]:
    """Let every timer callback take nothing but `self`, if it is a method."""
    made: list[Edit] = []
    for function in {each.lineno: each for each in _callbacks(text, "create_timer")}.values():
        kept = [each.arg for each in function.args.args if each.arg == "self"]
        if len(function.args.args) > len(function.args.defaults) + len(kept):
            made += edits.replace_parameters(text, function, kept)
    return sorted(made, key=lambda edit: -edit.first)


def done_callbacks(text: str, words: Words) -> Sequence[Edit]:
    """Pass a callback to `add_done_callback` where it is called instead, with its other arguments bound."""
    swaps: list[tuple[ast.expr, str]] = []
    for node in syntax_nodes(text):
        match node:
            case ast.Call(
                func=ast.Attribute(value=future, attr="add_done_callback"),
                args=[ast.Call(func=callback, args=given, keywords=[]) as called],
            ) if not given or ast.unparse(given[0]) == ast.unparse(future):
                names = [each.id for each in given[1:] if isinstance(each, ast.Name)]
                parameters = ", ".join(["done", *(f"{name}={name}" for name in names)])
                arguments = ", ".join(["done", *map(ast.unparse, given[1:])])
                becomes = f"lambda {parameters}: {ast.unparse(callback)}({arguments})"
                swaps.append((called, becomes if given[1:] else ast.unparse(callback)))
    return edits.replace_nodes(text, *swaps)


def own_executors(text: str, words: Words) -> Sequence[Edit] | None:
    """Spin each node in an executor of its own; None if the same node is spun twice."""
    swaps: list[tuple[ast.expr, str]] = []
    nodes: list[str] = []
    for call in syntax_nodes(text):
        match call:
            case ast.Call(func=ast.Attribute(ast.Name("rclpy"), "spin"), args=[node], keywords=[]):
                swaps.append((call, f"rclpy.spin({ast.unparse(node)}, SingleThreadedExecutor())"))
                nodes.append(ast.unparse(node))
            case ast.Call(keywords=given) if called_name(call) == "Thread":
                values = {each.arg: each.value for each in given}
                arguments = values.get("args")
                if isinstance(arguments, ast.Tuple) and last_name(values.get("target")) == "spin":
                    nodes += [ast.unparse(each) for each in arguments.elts[:1]]
                    if len(arguments.elts) == 1:
                        swaps.append((arguments, f"({nodes[-1]}, SingleThreadedExecutor())"))
    if len(set(nodes)) < len(nodes):
        return None
    imported = edits.add_import(text, "from rclpy.executors import SingleThreadedExecutor")
    return [*edits.replace_nodes(text, *swaps), *imported] if swaps else None


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
