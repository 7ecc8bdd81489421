"""Mistakes in parameter callbacks that show in the learner's file: the cause, with the step."""

from __future__ import annotations

import ast

from tutor.judge.edits import remove_statement, replace_node, replace_nodes
from tutor.judge.rewriting import parameter_callbacks, parameters
from tutor.judge.rewriting.node import NodeFile, argument, find_in_files, started_node
from tutor.judge.source import Function, calls_in, where
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause


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


def diagnose_broken_callback(trace: Trace) -> Cause | None:
    """Whether a parameter callback is never called, compares what is never equal, or sets a wrong attribute."""
    found = find_in_files(
        trace,
        _diagnose_refusal_afterwards,
        _diagnose_dotted_attribute,
        _diagnose_compared_type,
        _diagnose_compared_identity,
        _diagnose_class_attribute,
    )
    return found or diagnose_uncalled_callback(started_node(trace))


def _diagnose_refusal_afterwards(file: NodeFile) -> Cause | None:
    """Whether a post-set callback returns a SetParametersResult that refuses: rclpy ignores what it returns."""
    for call in file.calls(parameter_callbacks.POST_SET):
        function = file.function(argument(call, 0, "callback"))
        if function is None or not _may_refuse(file, function) or calls_in(function, "get_parameter"):
            continue
        code = f"{ast.unparse(call.func).rpartition('.')[0]}.{parameter_callbacks.ON_SET}"
        step = file.step([replace_node(file.text, call.func, code)])
        text = (
            f"{where(call)}: {function.name} is called after the values have been set, and what it returns is ignored"
        )
        return Cause("refused too late", text, step) if step else None
    return None


def _diagnose_dotted_attribute(file: NodeFile) -> Cause | None:
    """Whether `setattr` is given a name with a dot, such as "config." + name, which makes an attribute of that name."""
    for call in file.calls("setattr"):
        match call.args:
            case [owner, ast.BinOp(left=ast.Constant(value=str() as path), op=ast.Add(), right=name), value] if (
                path.endswith(".")
            ):
                code = ast.unparse(name)
            case [owner, ast.Constant(value=str() as path), value]:
                code = repr(path.rpartition(".")[2])
            case [
                owner,
                ast.JoinedStr(values=[ast.Constant(value=str() as path), ast.FormattedValue(value=name)]),
                value,
            ] if path.endswith("."):
                code = ast.unparse(name)
            case _:
                continue
        attribute = path.rpartition(".")[0]
        right = f"setattr({ast.unparse(owner)}.{attribute}, {code}, {ast.unparse(value)})"
        step = file.step([replace_node(file.text, call, right)]) if "." in path else None
        if step is not None:
            text = f"{where(call)}: setattr does not follow dots, so {attribute} stays as it is"
            return Cause("wrong attribute set", text, step)
    return None


def _diagnose_class_attribute(file: NodeFile) -> Cause | None:
    own = {
        ast.unparse(each) for each in file.nodes if isinstance(each, ast.Attribute) and isinstance(each.ctx, ast.Store)
    }
    stored = [
        each
        for each in file.nodes
        if isinstance(each, ast.Attribute)
        and isinstance(each.ctx, ast.Store)
        and ast.unparse(each.value) in file.node_classes
        and f"{file.name}.{each.attr}" in own
        and file.node_method(each) is not None
    ]
    step = file.step(replace_nodes(file.text, *((each, f"{file.name}.{each.attr}") for each in stored)))
    if not stored or step is None:
        return None
    text = f"{where(stored[0])} is the attribute of the class, and {file.name}.{stored[0].attr} hides it"
    return Cause("class attribute set", text, step)


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


def _diagnose_compared_identity(file: NodeFile) -> Cause | None:
    """Whether texts or numbers are compared with `is`, as in `parameter.name is "publish_rate"`."""
    compared = [
        each
        for each in file.nodes
        if isinstance(each, ast.Compare)
        and isinstance(each.ops[0], ast.Is | ast.IsNot)
        and isinstance(each.comparators[0], ast.Constant)
        and type(each.comparators[0].value) in (str, int, float)
    ]
    step = file.step(replace_nodes(file.text, *((each, _as_equality(each)) for each in compared)))
    if not compared or step is None:
        return None
    text = f"{where(compared[0])}: `is` compares whether both are the same object, which two equal texts need not be"
    return Cause("never the same object", text, step)


def _as_equality(compared: ast.Compare) -> str:
    """The code of a comparison with == or != in place of `is` or `is not`."""
    operator = ast.Eq() if isinstance(compared.ops[0], ast.Is) else ast.NotEq()
    return ast.unparse(ast.Compare(compared.left, [operator], compared.comparators))


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
        if function is not None and file.setup is not None and not _is_called(file, function):
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


def _is_called(file: NodeFile, function: Function) -> bool:
    """Whether the setup or the main program calls a function, directly or indirectly."""
    callers = [found for each in file.calls(function.name) if (found := file.function_around(each)) is not None]
    starting = [file.setup, *file.functions_named("main")]
    reached = [each for start in starting if start is not None for each in file.reachable_from(start)]
    return (
        function in reached or any(each in reached for each in callers) or len(callers) < len(file.calls(function.name))
    )


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


def _name_and_line(function: Function) -> str:
    return f"{function.name} (line {function.lineno})"
