"""Rewrite the callbacks that check parameter changes and let them take effect."""

from __future__ import annotations

import ast
from collections.abc import Sequence

from tutor.judge.edits import (
    Edit,
    insert_above,
    remove_lines,
    remove_statement,
    replace_lines,
    replace_node,
    replace_nodes,
)
from tutor.judge.rewriting.node import NodeFile, argument, rewrite_function
from tutor.judge.rewriting.parameters import is_text, readings, reads
from tutor.judge.source import Function, called_name

ON_SET = "add_on_set_parameters_callback"
POST_SET = "add_post_set_parameters_callback"
PRE_SET = "add_pre_set_parameters_callback"


def refuse_bad_rates(file: NodeFile, rate: str) -> list[Edit]:
    """Let an on-set callback refuse rates of 0 or less, before it does anything else."""
    checker = registered_callback(file, ON_SET)
    result, imported = file.import_name("SetParametersResult", "rcl_interfaces.msg")
    if checker is None:
        return _add_callback(file, "check_parameters", [_check("params", rate, result), _accept(result)], imported)
    params = _params_name(checker)
    return [*imported, *file.prepend_to(checker, _check(params, rate, result))] if params else []


def follow_parameters(file: NodeFile, rate: str, *others: str) -> list[Edit]:
    """Rewrite the parameter callbacks as a whole: refuse bad rates, and let every other value take effect."""
    checker, applier = registered_callback(file, ON_SET), registered_callback(file, POST_SET)
    applier = None if applier is checker else applier
    result, edits = file.import_name("SetParametersResult", "rcl_interfaces.msg")
    params = (_params_name(checker) if checker is not None else "") or "params"
    body = [_check(params, rate, result)]
    if applier is not None:
        applied = _params_name(applier) or "params"
        edits += [rewrite_function(applier, _apply_values(file, applied, rate, others), parameter=applied)]
    else:
        body.append(_apply_values(file, params, rate, others))
    body.append(_accept(result))
    keep_timer = _keep_timer(file, [each for each in (checker, applier) if each is not None])
    if checker is None:
        return _add_callback(file, "check_parameters", body, [*edits, *keep_timer])
    first = file.calls(ON_SET)[0]
    extra = [each for each in file.calls(ON_SET, PRE_SET) if each is not first]
    edits += [_remove_call(file, each) for each in extra]
    return [*edits, *keep_timer, rewrite_function(checker, "\n".join(body), parameter=params)]


def is_coroutine(file: NodeFile) -> bool:
    """Whether the on-set callback is an `async def`, which rclpy does not await."""
    return isinstance(registered_callback(file, ON_SET), ast.AsyncFunctionDef)


def without_async(file: NodeFile) -> list[Edit]:
    """Turn an on-set callback that is an `async def`, and the coroutines that it awaits, into plain functions."""
    checker = registered_callback(file, ON_SET)
    plain = [each for each in file.reachable_from(checker) if isinstance(each, ast.AsyncFunctionDef)] if checker else []
    names = {each.name for each in plain}
    calls = [
        (each, each.value)
        for each in file.nodes
        if isinstance(each, ast.Await) and isinstance(each.value, ast.Call) and called_name(each.value) in names
    ]
    lines = file.text.splitlines()
    return [
        *(replace_lines(each.lineno, lines[each.lineno - 1].strip().removeprefix("async ")) for each in plain),
        *replace_nodes(file.text, *((each, ast.get_source_segment(file.text, value) or "") for each, value in calls)),
    ]


def cancel_old_timer(file: NodeFile) -> list[Edit]:
    """Cancel the timer that a parameter callback replaces, if nothing else is missing there."""
    callbacks = [found for kind in (ON_SET, POST_SET) if (found := registered_callback(file, kind)) is not None]
    inside = [each for callback in callbacks for each in file.reachable_from(callback)]
    made = [each for each in file.timers if file.function_around(each) in inside]
    ended = [each for each in file.calls("cancel", "destroy_timer", "destroy") if file.function_around(each) in inside]
    timer = _timer_target(file)
    if (
        len(made) != 1
        or ended
        or file.assigned_to(made[0]) != timer
        or _current_timer_target(file) != timer
        or made[0] is file.first_timer
    ):
        return []
    return [insert_above(file.statement(made[0]).lineno, f"{timer}.cancel()")]


def registered_callback(file: NodeFile, kind: str) -> Function | None:
    """The function that is registered as a parameter callback of this kind, such as `ON_SET`; None if none is."""
    for call in file.calls(kind):
        given = argument(call, 0, "callback")
        if not isinstance(given, ast.Lambda | ast.Call) and (found := file.function(given)) is not None:
            return found
    return None


def register_on_set(file: NodeFile, function: Function) -> list[Edit]:
    """Register a function as an on-set callback."""
    is_method = file.class_of(function) is not None
    return file.append_to_setup(f"{file.name}.{ON_SET}({'self.' if is_method else ''}{function.name})")


def remove_pre_set_callback(file: NodeFile) -> list[Edit]:
    """Remove the callbacks that change the list of values before it is checked."""
    return [_remove_call(file, each) for each in file.calls(PRE_SET)]


def _remove_call(file: NodeFile, call: ast.Call) -> Edit:
    return remove_statement(file.text, file.statement(call))


def _params_name(function: Function) -> str:
    """The name of a callback's argument, the list of parameters; empty if it takes none."""
    names = [each.arg for each in function.args.args if each.arg not in ("self", "cls")]
    return names[0] if names else ""


def _add_callback(file: NodeFile, name: str, body: Sequence[str], more: Sequence[Edit]) -> list[Edit]:
    """Add and register an on-set callback: a method, or, if the node has no class, a function in the setup."""
    has_class = bool(file.new_method(""))
    code = "\n".join(f"    {line}" for part in body for line in part.splitlines())
    registered = file.calls(ON_SET)
    callback = argument(registered[0], 0, "callback") if registered else None
    if not has_class:
        register = file.append_to_setup(f"def {name}(params):\n{code}\n\n{file.name}.{ON_SET}({name})")
    elif callback is not None:
        register = [replace_node(file.text, callback, f"self.{name}")]
    else:
        register = file.append_to_setup(f"{file.name}.{ON_SET}(self.{name})")
    return [*more, *register, *file.new_method(f"def {name}(self, params):\n{code}")] if register else []


def _check(params: str, rate: str, result: str) -> str:
    """The code that refuses a bad rate in the list `params`."""
    each = _loop_variable(params)
    return (
        f"for {each} in {params}:\n"
        f"    if {each}.name == '{rate}' and {each}.value <= 0.0:\n"
        f"        return {result}(successful=False, reason='{rate} must be > 0')"
    )


def _accept(result: str) -> str:
    return f"return {result}(successful=True)"


def _loop_variable(params: str) -> str:
    return "param" if params == "p" else "p"


def _apply_values(file: NodeFile, params: str, rate: str, others: Sequence[str]) -> str:
    """The code that applies new values: it updates the attributes that hold them, and replaces the timer."""
    each = _loop_variable(params)
    branches = {name: _update_attributes(file, name, f"{each}.value") for name in (*others, rate)}
    created = file.first_timer
    has_timer = ""
    if created is not None:
        timer = _timer_target(file)
        branches[rate] += [f"{timer}.cancel()", f"{timer} = {_create_with_new_period(created, each)}"]
        if _is_registered_early(file):
            has_timer = f" and getattr({timer.rpartition('.')[0]}, '{timer.rpartition('.')[2]}', None)"
    tests = [
        f"{each}.name == '{name}'{has_timer if name == rate else ''}:\n"
        + "\n".join(f"        {line}" for line in lines)
        for name, lines in branches.items()
        if lines
    ]
    return f"for {each} in {params}:\n    if " + "\n    elif ".join(tests) if tests else ""


def _update_attributes(file: NodeFile, name: str, value: str) -> list[str]:
    """The lines that set the attributes in which the file keeps a parameter's value to the new one."""
    found: dict[str, str] = {}
    for node in ast.walk(file.tree):
        match node:
            case ast.Assign(targets=[ast.Attribute() as target], value=expression):
                pass
            case ast.AnnAssign(target=ast.Attribute() as target, value=ast.expr() as expression):
                pass
            case _:
                continue
        reading = next((each for each in ast.walk(expression) if reads(each, name)), None)
        if reading is not None and "create_timer" not in ast.unparse(expression):
            found.setdefault(ast.unparse(target), _with_value(expression, reading, value))
        elif _is_under_name_test(file, node, name) and ast.unparse(expression).endswith(".value"):
            found.setdefault(ast.unparse(target), value)
    own = f"{file.owner}."
    timer = _timer_target(file)
    return [f"{at} = {code}" for at, code in found.items() if at.startswith(own) and not at.startswith(timer)]


def _with_value(expression: ast.expr, reading: ast.AST, value: str) -> str:
    """The code to store for a new value: the value itself, or the same computation with it if that is a period."""
    if not any(isinstance(each, ast.Div) for each in ast.walk(expression)):
        return value
    return ast.unparse(expression).replace(ast.unparse(reading), value)


def _is_under_name_test(file: NodeFile, node: ast.AST, name: str) -> bool:
    """Whether a statement is within `if p.name == name:`."""
    for each in file.ancestors(node):
        match each:
            case ast.If(test=ast.Compare(comparators=[ast.Constant(value=str() as text)])):
                return text == name
    return False


def _timer_target(file: NodeFile) -> str:
    """Where the timer is kept, or where to keep it: an attribute such as "self.timer", or an item."""
    return target if _is_lasting(target := _current_timer_target(file)) else f"{file.owner}.timer"


def _current_timer_target(file: NodeFile) -> str:
    """The target that the first timer is assigned to, perhaps by the caller of a function that returns it."""
    created = file.first_timer
    if created is None:
        return ""
    maker = file.function_around(created)
    if maker is None or not isinstance(file.statement(created), ast.Return):
        return file.assigned_to(created)
    return next((target for call in file.calls(maker.name) if (target := file.assigned_to(call))), "")


def _is_lasting(target: str) -> bool:
    """Whether a target outlives its function: an attribute or an item."""
    return "." in target or "[" in target


def _keep_timer(file: NodeFile, without: Sequence[Function]) -> list[Edit]:
    """Keep the first timer in an attribute, unless one of the functions `without`, which are rewritten, creates it."""
    created = file.first_timer
    if created is None or _is_lasting(_current_timer_target(file)) or file.function_around(created) in without:
        return []
    timer = _timer_target(file)
    resets = [
        remove_lines(file.text, each.lineno)
        for each in ast.walk(file.tree)
        if isinstance(each, ast.Assign) and ast.unparse(each) == f"{timer} = None" and each.lineno > created.lineno
    ]
    return [replace_node(file.text, created, f"{timer} = {ast.unparse(created)}"), *resets]


def is_followed(file: NodeFile, name: str) -> bool:
    """Whether the timer's callback reads a parameter from the node, or a parameter callback compares its name."""
    callbacks = [found for kind in (ON_SET, POST_SET) if (found := registered_callback(file, kind)) is not None]
    inside = [each for callback in callbacks for each in file.reachable_from(callback)]
    timer_functions = file.reachable_from(file.timer_callback) if file.timer_callback is not None else []
    comparisons = [each for function in inside for each in ast.walk(function) if isinstance(each, ast.Compare)]
    return any(file.function_around(each) in timer_functions for each in readings(file, name)) or any(
        is_text(each, name) for test in comparisons for each in (test.left, *test.comparators)
    )


def _create_with_new_period(created: ast.Call, each: str) -> str:
    """The call that creates the timer, with the period that follows from the new value of the parameter `each`."""
    period = ast.parse(f"1.0 / {each}.value", mode="eval").body
    call = ast.parse(ast.unparse(created), mode="eval").body
    assert isinstance(call, ast.Call)
    if call.args:
        call.args[0] = period
    for keyword in call.keywords:
        if keyword.arg == "timer_period_sec":
            keyword.value = period
    return ast.unparse(call)


def _is_registered_early(file: NodeFile) -> bool:
    """Whether a callback is registered before parameters are declared, and so runs before there is a timer."""
    declared = file.calls("declare_parameter", "declare_parameters")
    return any(call.lineno < each.lineno for call in file.calls(ON_SET, POST_SET) for each in declared)
