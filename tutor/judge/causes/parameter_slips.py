"""Mistakes around parameters that show in one line of the learner's file: the cause, with the edit of that line.

Everything here explains a failure that is already certain; the source only shapes the wording. Each function returns
None if the source does not explain the failure.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from tutor.judge.edits import Edit, remove_statement, replace_node, replace_nodes
from tutor.judge.rewriting import parameter_callbacks, parameters
from tutor.judge.rewriting.node import NodeFile, argument
from tutor.judge.source import Function, called_name, values_of, where
from tutor.judge.verdict import Cause

_OVERWRITTEN = "value overwritten by the node"


def diagnose_override(file: NodeFile, name: str, *whole: list[Edit]) -> Cause | None:
    """Whether the code itself overwrites the parameter, or its copy of the parameter's value.

    `whole`: edits of the whole program, for the case that no smaller edit is right.
    """
    return (
        _diagnose_own_set(file, name)
        or _diagnose_ignored_overrides(file, name)
        or _diagnose_parameter_overrides(file, name, *whole)
        or _diagnose_reassignment(file, name)
    )


def _diagnose_parameter_overrides(file: NodeFile, name: str, *whole: list[Edit]) -> Cause | None:
    for call in file.calls("create_node", "Node", "__init__", *file.node_classes):
        given = {each.arg: each.value for each in call.keywords}
        if "parameter_overrides" not in given or name not in file.text:
            continue
        kept = [each for each in call.keywords if each.arg != "parameter_overrides"]
        removed = [replace_node(file.text, call, ast.unparse(ast.Call(call.func, call.args, kept)))]
        declared = name in {each.value for each in _constants(file.calls("declare_parameter", "declare_parameters"))}
        step = file.step(*([removed] if declared else []), *whole)
        text = f"line {call.lineno}: parameter_overrides takes precedence over the value given at start-up"
        return Cause(_OVERWRITTEN, text, step) if step else None
    return None


def _constants(calls: Sequence[ast.Call]) -> Iterator[ast.Constant]:
    for call in calls:
        yield from (each for each in ast.walk(call) if isinstance(each, ast.Constant))


def diagnose_callback_order(file: NodeFile) -> Cause | None:
    """Whether one on-set callback applies values that another one refuses.

    rclpy calls them in turn until one refuses, the last one added first (`Node.add_on_set_parameters_callback`).
    """
    calls = file.calls(parameter_callbacks.ON_SET)
    functions = [file.function(argument(call, 0, "callback")) for call in calls]
    refusing = [_may_refuse(file, each) for each in functions]
    changes = [
        replace_node(file.text, call.func, f"{ast.unparse(call.func.value)}.{parameter_callbacks.POST_SET}")
        for call, may_refuse in zip(calls, refusing, strict=True)
        if not may_refuse and isinstance(call.func, ast.Attribute)
    ]
    if any(each is None for each in functions) or not any(refusing) or not changes:
        return None
    step = file.step(changes)
    first, then = (next(f for f, may in zip(functions, refusing, strict=True) if f and may is x) for x in (False, True))
    text = (
        f"{first.name} applies the values, though {then.name} refuses them: of several on-set callbacks, the one added "
        "last is called first"
    )
    return Cause("value taken over before it is checked", text, step) if step else None


def _may_refuse(file: NodeFile, function: Function | None) -> bool:
    if function is None:
        return False
    return any("successful=False" in ast.unparse(each).replace(" ", "") for each in file.reachable_from(function))


def _diagnose_own_set(file: NodeFile, name: str) -> Cause | None:
    for call in file.calls("set_parameters", "set_parameters_atomically"):
        function = file.function_around(call)
        code = ast.unparse(call) if "[" in ast.unparse(call) or function is None else ast.unparse(function)
        statement = file.statement(call)
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


def _diagnose_ignored_overrides(file: NodeFile, name: str) -> Cause | None:
    found: list[tuple[ast.expr, str]] = []
    first: ast.Call | None = None
    for call in file.calls("declare_parameter", "declare_parameters"):
        given = argument(call, 3 if called_name(call) == "declare_parameter" else 2, "ignore_override")
        if given is not None and ast.unparse(given) == "True":
            first = first or call if name in ast.unparse(call) else first
            found.append((given, "False"))
    step = file.step(replace_nodes(file.text, *found)) if first is not None else None
    if first is None or step is None:
        return None
    text = f"{where(first)}: with ignore_override True, the value given at start-up is ignored"
    return Cause(_OVERWRITTEN, text, step)


def _diagnose_reassignment(file: NodeFile, name: str) -> Cause | None:
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
            step = file.step([remove_statement(file.text, node)])
            text = f"{where(node)} overwrites the value of {name} that line {kept.lineno} has read"
            return Cause(_OVERWRITTEN, text, step) if step else None
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
    return any(isinstance(each, ast.Call) and called_name(each) == "remove_ros_args" for each in found)


def diagnose_broken_callback(file: NodeFile) -> Cause | None:
    """Whether a parameter callback is never called, or compares a parameter's type with what it never equals."""
    return diagnose_uncalled_callback(file) or _diagnose_compared_type(file)


def _diagnose_compared_type(file: NodeFile) -> Cause | None:
    compared = [
        each.left
        for each in file.nodes
        if isinstance(each, ast.Compare)
        and isinstance(each.left, ast.Attribute)
        and each.left.attr in ("type_", "type")
        and any("PARAMETER_" in ast.unparse(one) for one in each.comparators)
    ]
    step = file.step(replace_nodes(file.text, *((each, f"{ast.unparse(each)}.value") for each in compared)))
    if not compared or step is None:
        return None
    text = f"{where(compared[0])} compares a Parameter.Type with a number of ParameterType: they are never equal"
    return Cause("types never equal", text, step)


def diagnose_uncalled_callback(file: NodeFile) -> Cause | None:
    """Whether an existing parameter callback is never called, or another function than the intended one is."""
    for call in file.calls(parameter_callbacks.ON_SET, parameter_callbacks.POST_SET):
        given = argument(call, 0, "callback")
        if isinstance(given, ast.Call) and file.function(given.func) is not None:
            step = file.step([replace_node(file.text, given, ast.unparse(given.func))])
            text = f"{where(call)} calls the callback at once, and registers what it returns"
            return Cause("callback not registered", text, step) if step else None
        if (twice := _diagnose_second_definition(file, given)) is not None:
            return twice
        function = file.function_around(call)
        if function is not None and file.setup is not None and function not in file.reachable_from(file.setup):
            step = file.step([*file.append_to_setup(ast.unparse(call))])
            text = f"{where(call)} is in {function.name}, which nothing calls when the node starts"
            return Cause("callback not registered", text, step) if step else None
    if file.calls(parameter_callbacks.ON_SET, parameter_callbacks.POST_SET, parameter_callbacks.PRE_SET):
        return None
    unused = _find_unused_callback(file)
    step = file.step(parameter_callbacks.register_on_set(file, unused)) if unused is not None else None
    if unused is None or step is None:
        return None
    return Cause("callback not registered", f"there is {_name_and_line(unused)}, but nothing ever calls it", step)


def _diagnose_second_definition(file: NodeFile, given: ast.expr | None) -> Cause | None:
    name = ast.unparse(given).rpartition(".")[2] if given is not None else ""
    same = [each for each in file.functions if each.name == name]
    if len(same) < 2 or len({file.class_of(each) for each in same}) > 1:
        return None
    first, last = same[0], same[-1]
    step = file.step([remove_statement(file.text, last)])
    text = (
        f"{name} is defined in line {first.lineno} and again in line {last.lineno}: the second replaces the first, "
        "which is never called"
    )
    return Cause("callback defined twice", text, step) if step else None


def _find_unused_callback(file: NodeFile) -> Function | None:
    """A function that looks like a parameter callback, but is never used."""
    used = {each.attr for each in ast.walk(file.tree) if isinstance(each, ast.Attribute)}
    used |= {each.id for each in ast.walk(file.tree) if isinstance(each, ast.Name)}
    return next(
        (each for each in file.functions if each.name not in used and "SetParametersResult" in ast.unparse(each)),
        None,
    )


def diagnose_old_value_read(file: NodeFile, name: str) -> Cause | None:
    """Whether an on-set callback reads the parameter from the node, which still has the old value then.

    The hint is for a callback that loops over the list of parameters; for any other, it is empty.
    """
    checker = parameter_callbacks.registered_callback(file, parameter_callbacks.ON_SET)
    if checker is None:
        return None
    timer_callbacks = [file.function(argument(each, 1, "callback")) for each in file.timers]
    inside = [each for each in file.reachable_from(checker) if each not in timer_callbacks]
    reads = [each for each in parameters.readings(file, name) if file.function_around(each) in inside]
    if not reads:
        return None
    text = (
        f"{where(reads[0])} still gives the old value here: an on-set callback is called before the new one is stored"
    )
    loops = [
        each for each in file.ancestors(reads[0]) if isinstance(each, ast.For) and isinstance(each.target, ast.Name)
    ]
    target = loops[0].target if loops else None
    new = f"{target.id}.value" if isinstance(target, ast.Name) else ""
    return Cause("old value used", text, file.step([replace_node(file.text, reads[0], new)] if new else None) or "")


def why_accepted(file: NodeFile, bad: float) -> str:
    """Why a bad number is not refused, judging by the parameter callbacks."""
    checker = parameter_callbacks.registered_callback(file, parameter_callbacks.ON_SET)
    if checker is None:
        later = parameter_callbacks.registered_callback(file, parameter_callbacks.POST_SET)
        if later is not None:
            return f"{_name_and_line(later)} is called when the value is already set: it cannot reject any"
        return "nothing can reject a value: no on-set-parameters callback is registered"
    code = "".join(map(ast.unparse, file.reachable_from(checker)))
    if "successful=False" not in code and "successful = False" not in code:
        return f"{_name_and_line(checker)} never says no: nothing rejects {bad}"
    return (
        f"{_name_and_line(checker)} can say no, but does not for {bad}: it has to look at the new value, the one in "
        "its argument, and at every number that is 0 or less"
    )


def _target(assignment: ast.Assign | ast.AnnAssign) -> ast.expr:
    return assignment.targets[0] if isinstance(assignment, ast.Assign) else assignment.target


def _in_init(file: NodeFile, node: ast.AST) -> bool:
    function = file.function_around(node)
    return function is None or function is file.setup


def _name_and_line(function: Function) -> str:
    return f"{function.name} (line {function.lineno})"
