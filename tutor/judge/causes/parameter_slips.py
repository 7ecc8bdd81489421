"""Mistakes around parameters that show in one line of the learner's file: the cause, with the edit of that line.

Everything here explains a failure that is already certain; the source only shapes the wording. Each function returns
None if the source does not explain the failure.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from tutor.judge.edits import (
    Edit,
    insert_after,
    remove_keyword,
    remove_statement,
    replace_node,
    replace_nodes,
    replace_statement,
)
from tutor.judge.rewriting import parameters
from tutor.judge.rewriting.node import NodeFile, argument
from tutor.judge.source import called_name, values_of, where
from tutor.judge.verdict import Cause

_OVERWRITTEN = "value overwritten by the node"
_DECLARE = ("declare_parameter", "declare_parameters")
_OVERRIDE_ARGUMENTS = "parameter_overrides", "automatically_declare_parameters_from_overrides"
_CONVERSIONS = frozenset({"float", "int", "str", "round"})


def diagnose_override(file: NodeFile, name: str, *whole: list[Edit]) -> Cause | None:
    """Whether the code itself overwrites the parameter, or its copy of the parameter's value.

    `whole`: edits of the whole program, for the case that no smaller edit is right.
    """
    return (
        _diagnose_value_message(file, name)
        or _diagnose_own_set(file, name)
        or _diagnose_ignored_overrides(file, name)
        or _diagnose_own_arguments(file, name)
        or _diagnose_parameter_overrides(file, name, *whole)
        or _diagnose_overrides_in_options(file, name)
        or _diagnose_reassignment(file, name)
    )


def _diagnose_value_message(file: NodeFile, name: str) -> Cause | None:
    """Whether get_parameter_value(), a message with a field for each type, is converted as if it were the value."""
    swaps: list[tuple[ast.expr, str]] = []
    own: ast.Call | None = None
    for call in file.calls("get_parameter_value"):
        around = next(file.ancestors(call), None)
        if (
            isinstance(around, ast.Call)
            and called_name(around) in _CONVERSIONS
            and isinstance(call.func, ast.Attribute)
        ):
            swaps.append((call, f"{ast.unparse(call.func.value)}.value"))
            if repr(name) in ast.unparse(call):
                own = call
    step = file.step(replace_nodes(file.text, *swaps)) if own is not None else None
    if own is None or step is None:
        return None
    text = f"{where(own)} is a message with a field for each type of value, which cannot be converted to the value"
    return Cause("parameter value not read", text, step)


def _texts_in(file: NodeFile, given: ast.expr) -> set[str]:
    """The texts in an expression, or in what the variable is assigned that it consists of."""
    assigned = values_of(given.id, file.function_around(given) or file.tree) if isinstance(given, ast.Name) else []
    nodes = (node for each in (given, *assigned) for node in ast.walk(each))
    return {each.value for each in nodes if isinstance(each, ast.Constant) and isinstance(each.value, str)}


def _diagnose_parameter_overrides(file: NodeFile, name: str, *whole: list[Edit]) -> Cause | None:
    for call in file.calls("create_node", "Node", "__init__", *file.node_classes):
        given = {each.arg: each.value for each in call.keywords}
        if "parameter_overrides" not in given:
            continue
        overridden, declarations = _texts_in(file, given["parameter_overrides"]), file.calls(*_DECLARE)
        if overridden and name not in overridden:  # without any text, the names come from a table
            continue
        removed = [remove_keyword(file.text, call, "parameter_overrides")]
        declared_names = [set(filter(None, _texts_in(file, each))) for each in declarations]
        declared = any(name in names or not names for names in declared_names)
        step = file.step(*([removed] if declared else []), *whole)
        text = f"line {call.lineno}: parameter_overrides takes precedence over the value given at start-up"
        return Cause(_OVERWRITTEN, text, step) if step else None
    return None


def _diagnose_overrides_in_options(file: NodeFile, name: str) -> Cause | None:
    """Whether parameter_overrides is in a dict of keyword arguments."""
    begin = next((call for call in file.calls("__init__") if ast.unparse(call.func) == "super().__init__"), None)
    declared = _declarations(file)
    for options in file.nodes:
        if begin is None or not isinstance(options, ast.Dict):
            continue
        keys = [each.value for each in options.keys if isinstance(each, ast.Constant)]
        kept = [
            f"{ast.unparse(key)}: {ast.unparse(value)}" if key else f"**{ast.unparse(value)}"
            for key, value in zip(options.keys, options.values, strict=True)
            if not (isinstance(key, ast.Constant) and key.value in _OVERRIDE_ARGUMENTS)
        ]
        if "parameter_overrides" not in keys or not any(repr(name) in each for each in declared):
            continue
        removed = replace_node(file.text, options, f"{{{', '.join(kept)}}}")
        added = [] if file.calls(*_DECLARE) else [insert_after(file.statement(begin), "\n".join(declared))]
        if (step := file.step([removed, *added])) is not None:
            text = f"line {options.lineno}: parameter_overrides takes precedence over the value given at start-up"
            return Cause(_OVERWRITTEN, text, step)
    return None


def _constants(calls: Sequence[ast.Call]) -> Iterator[ast.Constant]:
    for call in calls:
        yield from (each for each in ast.walk(call) if isinstance(each, ast.Constant))


def _diagnose_own_set(file: NodeFile, name: str) -> Cause | None:
    for call in file.calls("set_parameters", "set_parameters_atomically"):
        function = file.function_around(call)
        code = ast.unparse(call) if "[" in ast.unparse(call) or function is None else ast.unparse(function)
        made = [each.id for given in call.args for each in ast.walk(given) if isinstance(each, ast.Name)]
        code = " ".join([code, *(ast.unparse(value) for each in made for value in values_of(each, file.tree))])
        statement = file.statement(call)
        if function is file.setup and any(isinstance(each, ast.If) for each in file.ancestors(call)):
            continue  # a fallback for a bad value
        declared = [] if file.calls("declare_parameter", "declare_parameters") else _declarations(file)
        if any(repr(name) in each for each in declared):
            step = file.step([replace_statement(statement, "\n".join(declared))])
            text = f"{where(call)} sets {name}, which was not declared, so a value given at start-up is ignored"
            return Cause("parameter not declared", text, step) if step else None
        step = file.step([remove_statement(file.text, statement)])
        if name in code and step is not None:
            return Cause(
                _OVERWRITTEN,
                f"{where(call)} sets {name} itself, so a value set from outside does not last",
                step,
            )
        names_others = any(isinstance(each.value, str) for each in _constants([call]))
        at_end_of_setup = function is not None and function is file.setup and statement in function.body
        if call.args and at_end_of_setup and not names_others:
            current = f"[{file.name}.get_parameter(each.name) for each in {ast.unparse(call.args[0])}]"
            if (step := file.step([replace_node(file.text, call.args[0], current)])) is not None:
                text = f"{where(call)} sets the defaults again, so a value given at start-up does not last"
                return Cause(_OVERWRITTEN, text, step)
    return None


def _declarations(file: NodeFile) -> list[str]:
    """The code that declares each parameter of which the file makes a Parameter object with a value."""
    found: dict[str, str] = {}
    for call in file.calls("Parameter"):
        name, value = argument(call, 0, "name"), argument(call, 2, "value")
        if isinstance(name, ast.Constant) and value is not None:
            code = f"{file.name}.declare_parameter({ast.unparse(name)}, {ast.unparse(value)})"
            found.setdefault(ast.unparse(name), code)
    return list(found.values())


def _diagnose_own_arguments(file: NodeFile, name: str) -> Cause | None:
    for call in file.calls("create_node", "Node", "__init__", *file.node_classes):
        if any(each.arg == "cli_args" and f"{name}:=" in ast.unparse(each) for each in call.keywords):
            step = file.step([remove_keyword(file.text, call, "cli_args")])
            text = f"line {call.lineno}: cli_args of the node takes precedence over the value given at start-up"
            return Cause(_OVERWRITTEN, text, step) if step else None
    return None


def diagnose_read_only(file: NodeFile) -> Cause | None:
    """Whether parameters are declared read-only, by an argument, an attribute or a function's default value."""
    found: list[ast.expr] = []
    for node in file.nodes:
        match node:
            case ast.keyword(arg="read_only", value=value):
                found.append(value)
            case ast.Assign(targets=[ast.Attribute(attr="read_only")], value=value):
                found.append(value)
            case ast.arguments(args=given, defaults=defaults) if defaults:
                named = zip(given[-len(defaults) :], defaults, strict=True)
                found += [default for each, default in named if each.arg == "read_only"]
    true = [each for each in found if isinstance(each, ast.Constant) and each.value is True]
    step = file.step(replace_nodes(file.text, *((each, "False") for each in true)))
    if not true or step is None:
        return None
    text = f"line {true[0].lineno} makes a parameter read-only, so it keeps its initial value"
    return Cause("read-only parameter", text, step)


def _diagnose_ignored_overrides(file: NodeFile, name: str) -> Cause | None:
    found: list[tuple[ast.expr, str]] = []
    first: ast.Call | None = None
    for call in file.calls("declare_parameter", "declare_parameters"):
        single = called_name(call) == "declare_parameter"
        given = argument(call, 3 if single else 2, "ignore_override")
        if given is not None and ast.unparse(given) == "True":
            declared = argument(call, 0, "name") if single else argument(call, 1, "parameters")
            own = name in ast.unparse(call) or isinstance(declared, ast.Name | ast.Attribute)  # all, in a loop or table
            first = first or call if own else first
            found.append((given, "False"))
    step = file.step(replace_nodes(file.text, *found)) if first is not None else None
    if first is None or step is None:
        return None
    text = f"{where(first)}: with ignore_override True, the value given at start-up is ignored"
    return Cause(_OVERWRITTEN, text, step)


def _diagnose_reassignment(file: NodeFile, name: str) -> Cause | None:
    found = _find_reassignment(file, name)
    if found is None:
        return None
    kept, overwriting = found
    declared = {each.value for each in _constants(file.calls("declare_parameter", "declare_parameters"))}
    others = (_find_reassignment(file, each) for each in sorted(map(str, declared - {name})))
    statements = {other.lineno: other for _, other in filter(None, others)} | {overwriting.lineno: overwriting}
    step = file.step([remove_statement(file.text, each) for each in statements.values()])
    text = f"{where(overwriting)} overwrites the value of {name} that line {kept.lineno} has read"
    return Cause(_OVERWRITTEN, text, step) if step else None


def _find_reassignment(file: NodeFile, name: str) -> tuple[ast.stmt, ast.Assign] | None:
    """The statement that keeps the parameter's value, and the one that overwrites it with a constant."""
    kept = parameters.find_kept_value(file, name)
    for node in ast.walk(file.tree):
        if kept is None or not isinstance(node, ast.Assign) or not isinstance(node.value, ast.Constant):
            continue
        later = (
            node.lineno > kept.lineno
            if file.function_around(node) is file.function_around(kept)
            else not _in_init(file, node)
        )
        target = ast.unparse(node.targets[0])
        corrected = any(isinstance(each, ast.If) and target in ast.unparse(each.test) for each in file.ancestors(node))
        if target == ast.unparse(_target(kept)) and later and not corrected:  # replacing a bad value is fine
            return kept, node
    return None


def diagnose_parameter_object(file: NodeFile, name: str) -> Cause | None:
    """Whether the Parameter itself is used where its value is meant."""
    for call in file.calls("get_parameter", "declare_parameter"):
        around = next(file.ancestors(call), None)
        constants = [each.value for each in _constants([call])]
        kept = ast.unparse(around.targets[0]) if isinstance(around, ast.Assign) else ""
        if kept and re.search(rf"{re.escape(kept)}\.(value|get_parameter_value)\b", file.text):
            continue
        if isinstance(around, ast.Assign | ast.FormattedValue) and name in constants[:1]:
            step = file.step([replace_node(file.text, call, f"{ast.unparse(call)}.value")])
            text = f"{where(call)} gives a Parameter object, and its value is in .value"
            return Cause("parameter object", text, step) if step else None
    return None


def diagnose_dropped_arguments(file: NodeFile) -> Cause | None:
    """Whether the node does not get the arguments of its command line, and so no parameter that is given there."""
    for call in file.calls("init", "__init__", "Node", "create_node", *file.node_classes):
        given = next((each.value for each in call.keywords if each.arg == "use_global_arguments"), None)
        if given is not None and ast.unparse(given) == "False":
            edit = replace_node(file.text, given, "True")
        elif called_name(call) == "init" and (empty := _empty_list(file, argument(call, 0, "args"))) is not None:
            edit = replace_node(file.text, empty, "None")
        elif called_name(call) == "init" and _has_no_ros_arguments(file, argument(call, 0, "args")):
            edit = replace_node(file.text, call, f"{ast.unparse(call.func)}()")
        else:
            continue
        if (step := file.step([edit])) is not None:
            text = f"{where(call)}: the node does not get the arguments that are given at start-up"
            return Cause("arguments left out", text, step)
    return None


def _empty_list(file: NodeFile, given: ast.expr | None) -> ast.expr | None:
    """The empty list that is given, or that is the default of the function's argument that is given."""
    function = file.function_around(given) if isinstance(given, ast.Name) else None
    if isinstance(given, ast.Name) and function is not None:
        positional = function.args.args
        defaults = dict(
            zip([each.arg for each in reversed(positional)], reversed(function.args.defaults), strict=False)
        )
        given = defaults.get(given.id)
    return given if isinstance(given, ast.List | ast.Tuple) and not given.elts else None


def _has_no_ros_arguments(file: NodeFile, given: ast.expr | None) -> bool:
    """Whether the ROS arguments have been taken out of the list that is given, or out of what it is assigned."""
    function = file.function_around(given) if given is not None else None
    assigned = values_of(ast.unparse(given), function or file.tree) if isinstance(given, ast.Name) else []
    found = [each for value in (given, *assigned) if value is not None for each in ast.walk(value)]
    return any(isinstance(each, ast.Call) and called_name(each) == "remove_ros_args" for each in found) or any(
        map(_leaves_out_arguments, found)
    )


def _leaves_out_arguments(node: ast.AST) -> bool:
    """Whether this is a part of sys.argv that leaves out more than the name of the program."""
    match node:
        case ast.Subscript(value=ast.Attribute(attr="argv"), slice=ast.Slice(lower=lower, upper=upper, step=None)):
            return upper is not None or (isinstance(lower, ast.Constant) and lower.value not in (None, 0, 1))
    return False


def _target(assignment: ast.Assign | ast.AnnAssign) -> ast.expr:
    return assignment.targets[0] if isinstance(assignment, ast.Assign) else assignment.target


def _in_init(file: NodeFile, node: ast.AST) -> bool:
    function = file.function_around(node)
    return function is None or function is file.setup
