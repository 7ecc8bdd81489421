"""The parameters of a learner's node, declared and followed: their declarations and callbacks, rewritten."""

from __future__ import annotations

import ast
import difflib
import re
from collections.abc import Sequence

from tutor.judge.edits import (
    Edit,
    insert_above,
    insert_after,
    remove_lines,
    remove_statement,
    replace_lines,
    replace_node,
    replace_nodes,
)
from tutor.judge.rewriting.node import NodeFile, argument, rewrite_function
from tutor.judge.source import Function

ON_SET = "add_on_set_parameters_callback"
POST_SET = "add_post_set_parameters_callback"
PRE_SET = "add_pre_set_parameters_callback"
_READING = {"get_parameter", "get_parameter_or", "declare_parameter"}


def refuse_bad_rates(file: NodeFile, rate: str) -> list[Edit]:
    """An on-set callback that refuses rates of 0 and less, before it does anything else."""
    checker = registered_callback(file, ON_SET)
    result, imported = file.own("SetParametersResult", "rcl_interfaces.msg")
    if checker is None:
        return _new_callback(file, "check_parameters", [_check("params", rate, result), _accept(result)], imported)
    given = _argument(checker)
    return [*imported, *file.prepend_to(checker, _check(given, rate, result))] if given else []


def follow_parameters(file: NodeFile, rate: str, *others: str) -> list[Edit]:
    """The parameter callbacks as a whole: bad rates are refused, and every other value takes effect."""
    checker, applier = registered_callback(file, ON_SET), registered_callback(file, POST_SET)
    applier = None if applier is checker else applier
    result, edits = file.own("SetParametersResult", "rcl_interfaces.msg")
    given = (_argument(checker) if checker is not None else "") or "params"
    body = [_check(given, rate, result)]
    if applier is not None:
        into = _argument(applier) or "params"
        edits += [rewrite_function(applier, _effect(file, into, rate, others), given=into)]
    else:
        body.append(_effect(file, given, rate, others))
    body.append(_accept(result))
    keeping = _kept_timer(file, [each for each in (checker, applier) if each is not None])
    if checker is None:
        return _new_callback(file, "check_parameters", body, [*edits, *keeping])
    first = file.calls(ON_SET)[0]
    extra = [each for each in file.calls(ON_SET, PRE_SET) if each is not first]
    edits += [_without(file, each) for each in extra]
    return [*edits, *keeping, rewrite_function(checker, "\n".join(body), given=given)]


def cancel_old_timer(file: NodeFile) -> list[Edit]:
    """The timer that a parameter callback replaces is cancelled there, if that is all that is missing."""
    callbacks = [found for kind in (ON_SET, POST_SET) if (found := registered_callback(file, kind)) is not None]
    inside = [each for callback in callbacks for each in file.reached(callback)]
    made = [each for each in file.timers if file.function_around(each) in inside]
    ended = [each for each in file.calls("cancel", "destroy_timer", "destroy") if file.function_around(each) in inside]
    timer = _timer(file)
    if (
        len(made) != 1
        or ended
        or file.assigned_to(made[0]) != timer
        or _kept_in(file) != timer
        or made[0] is file.first_timer
    ):
        return []
    return [insert_above(file.statement(made[0]).lineno, f"{timer}.cancel()")]


def registered_callback(file: NodeFile, kind: str) -> Function | None:
    """The function that is registered as a parameter callback of this kind."""
    for call in file.calls(kind):
        given = argument(call, 0, "callback")
        if not isinstance(given, ast.Lambda | ast.Call) and (found := file.function(given)) is not None:
            return found
    return None


def register_on_set(file: NodeFile, function: Function) -> list[Edit]:
    """A function, registered as on-set callback."""
    inside = file.class_of(function) is not None
    return file.append_to_setup(f"{file.name}.{ON_SET}({'self.' if inside else ''}{function.name})")


def remove_pre_set_callback(file: NodeFile) -> list[Edit]:
    """No callback that changes the list of values before they are checked."""
    return [_without(file, each) for each in file.calls(PRE_SET)]


def declare_parameter(file: NodeFile, name: str, default: object, *, plain: bool = False) -> list[Edit]:
    """A parameter, declared with its default; `plain`: without a descriptor or anything else."""
    code = f"{file.name}.declare_parameter({name!r}, {default!r})"
    for call in file.calls("declare_parameter"):
        given = argument(call, 1, "value")
        if _is_text(argument(call, 0, "name"), name):
            return [
                replace_node(file.text, call, code)
                if plain or given is None
                else replace_node(file.text, given, repr(default))
            ]
    for each in ast.walk(file.tree):
        if (given := _default_beside(each, name)) is not None:
            if plain and isinstance(each, ast.Tuple):
                return [replace_node(file.text, each, f"({name!r}, {default!r})")]
            return [replace_node(file.text, given, repr(default))]
    return _below_super(file, code)


def rename_parameter(file: NodeFile, name: str, others: Sequence[str]) -> list[Edit]:
    """A parameter that is declared under a name much like this one, called by this one wherever it is named."""
    declared = [argument(each, 0, "name") for each in file.calls("declare_parameter")]
    names = [str(each.value) for each in declared if isinstance(each, ast.Constant)]
    near = [each for each in names if each not in (name, *others) and _alike(each, name)]
    if not near or name in names:
        return []
    lines = {each.lineno for each in ast.walk(file.tree) if isinstance(each, ast.Constant) and each.value == near[0]}
    texts = file.text.splitlines()
    quoted = re.compile(rf"(?<=['\"]){re.escape(near[0])}(?=['\"])")
    return [replace_lines(line, quoted.sub(name, texts[line - 1].strip())) for line in sorted(lines)]


def _alike(one: str, other: str) -> bool:
    return one in other or other in one or difflib.SequenceMatcher(None, one, other).ratio() > 0.6


def declare_once(file: NodeFile, line: int) -> list[Edit]:
    """What the function of this line declares each time that it is called, declared with the node, and only read."""
    calls = file.calls("declare_parameter")
    function = next(
        (file.function_around(each) for each in calls if each.lineno <= line <= (each.end_lineno or 0)), None
    )
    again = [each for each in calls if function is not None and file.function_around(each) is function]
    if function is None or function is file.setup:
        return []
    elsewhere = {ast.unparse(each.args[0]) for each in calls if each not in again and each.args}
    bare = [file.statement(each) for each in again if isinstance(file.statement(each), ast.Expr)]
    reads = [
        (each, f"{file.name}.get_parameter({ast.unparse(each.args[0])})")
        for each in again
        if each.args and file.statement(each) not in bare
    ]
    missing = [ast.unparse(each) for each in again if each.args and ast.unparse(each.args[0]) not in elsewhere]
    return [
        *(remove_statement(file.text, each) for each in bare),
        *replace_nodes(file.text, *reads),
        *(_below_super(file, "\n".join(missing)) if missing else []),
    ]


def _below_super(file: NodeFile, code: str) -> list[Edit]:
    """Code that comes as soon as the node is there."""
    for call in file.calls("__init__", "create_node", "Node"):
        statement = file.statement(call)
        if file.function_around(call) is file.setup and not isinstance(statement, ast.ClassDef | ast.FunctionDef):
            return [insert_after(statement, code)]
    return file.append_to_setup(code)


def check_at_start(file: NodeFile, rate: str) -> list[Edit]:
    """A bad rate that the node is started with, found by the parameter's name."""
    calls = [each for each in file.calls("declare_parameter", "declare_parameters") if rate in ast.unparse(each)]
    if not calls:
        return []
    statement = file.statement(calls[0])
    code = (
        f"if {file.value(rate)} <= 0.0:\n"
        f"    {file.name}.get_logger().fatal('{rate} must be > 0')\n"
        "    raise SystemExit(1)"
    )
    return [insert_after(statement, code)]


def _default_beside(node: ast.AST, name: str) -> ast.expr | None:
    """The default that stands beside a parameter's name, in a call, a tuple or a dict."""
    match node:
        case ast.Tuple(elts=[first, second, *_]) | ast.List(elts=[first, second]) if _is_text(first, name):
            return second
        case ast.Dict(keys=keys, values=values):
            pairs = zip(keys, values, strict=True)
            return next((value for key, value in pairs if key is not None and _is_text(key, name)), None)
        case ast.Call(func=ast.Name(id="dict"), keywords=given):
            return next((each.value for each in given if each.arg == name), None)
    return None


def _is_text(node: ast.expr | None, text: str) -> bool:
    return isinstance(node, ast.Constant) and node.value == text


def _without(file: NodeFile, call: ast.Call) -> Edit:
    statement = file.statement(call)
    return remove_statement(file.text, statement)


def _argument(function: Function) -> str:
    """What the function calls the list of parameters; empty where it takes none."""
    names = [each.arg for each in function.args.args if each.arg not in ("self", "cls")]
    return names[0] if names else ""


def _new_callback(file: NodeFile, name: str, body: Sequence[str], more: Sequence[Edit]) -> list[Edit]:
    """A method, registered; where the node has no class, a function above the line that registers it."""
    method = file.new_method("")
    code = "\n".join(f"    {line}" for part in body for line in part.splitlines())
    given = file.calls(ON_SET)
    callback = argument(given[0], 0, "callback") if given else None
    if not method:
        register = file.append_to_setup(f"def {name}(params):\n{code}\n\n{file.name}.{ON_SET}({name})")
    elif callback is not None:
        register = [replace_node(file.text, callback, f"self.{name}")]
    else:
        register = file.append_to_setup(f"{file.name}.{ON_SET}(self.{name})")
    return [*more, *register, *file.new_method(f"def {name}(self, params):\n{code}")] if register else []


def _check(given: str, rate: str, result: str) -> str:
    each = _loop(given)
    return (
        f"for {each} in {given}:\n"
        f"    if {each}.name == '{rate}' and {each}.value <= 0.0:\n"
        f"        return {result}(successful=False, reason='{rate} must be > 0')"
    )


def _accept(result: str) -> str:
    return f"return {result}(successful=True)"


def _loop(given: str) -> str:
    return "param" if given == "p" else "p"


def _effect(file: NodeFile, given: str, rate: str, others: Sequence[str]) -> str:
    """What is to be done about new values: what the file keeps of them, and the timer."""
    each = _loop(given)
    branches = {name: _kept(file, name, f"{each}.value") for name in (*others, rate)}
    made = file.first_timer
    early = ""
    if made is not None:
        timer = _timer(file)
        branches[rate] += [f"{timer}.cancel()", f"{timer} = {_made_again(made, each)}"]
        if _is_early(file):
            early = f" and getattr({timer.rpartition('.')[0]}, '{timer.rpartition('.')[2]}', None)"
    tests = [
        f"{each}.name == '{name}'{early if name == rate else ''}:\n" + "\n".join(f"        {line}" for line in lines)
        for name, lines in branches.items()
        if lines
    ]
    return f"for {each} in {given}:\n    if " + "\n    elif ".join(tests) if tests else ""


def _kept(file: NodeFile, name: str, value: str) -> list[str]:
    """The attributes in which the file keeps a parameter's value, set to the new one."""
    found: dict[str, str] = {}
    for node in ast.walk(file.tree):
        match node:
            case ast.Assign(targets=[ast.Attribute() as target], value=expression):
                pass
            case ast.AnnAssign(target=ast.Attribute() as target, value=ast.expr() as expression):
                pass
            case _:
                continue
        reading = next((each for each in ast.walk(expression) if _reads(each, name)), None)
        if reading is not None and "create_timer" not in ast.unparse(expression):
            found.setdefault(ast.unparse(target), _with_value(expression, reading, value))
        elif _set_on(file, node, name) and ast.unparse(expression).endswith(".value"):
            found.setdefault(ast.unparse(target), value)
    own = f"{file.holder}."
    timer = _timer(file)
    return [f"{at} = {code}" for at, code in found.items() if at.startswith(own) and not at.startswith(timer)]


def _reads(node: ast.AST, name: str) -> bool:
    """Whether this is `node.get_parameter(name).value`, or another way to write it."""
    if not isinstance(node, ast.Attribute) or not node.attr.endswith("value"):
        return False
    inner: ast.expr = node.value
    while isinstance(inner, ast.Attribute | ast.Call):
        if isinstance(inner, ast.Call) and isinstance(inner.func, ast.Attribute) and inner.func.attr in _READING:
            return _is_text(argument(inner, 0, "name"), name)
        inner = inner.func if isinstance(inner, ast.Call) else inner.value
    return False


def readings(file: NodeFile, name: str) -> list[ast.expr]:
    """Where a parameter's value is read from the node."""
    return [each for each in ast.walk(file.tree) if isinstance(each, ast.expr) and _reads(each, name)]


def find_kept_value(file: NodeFile, name: str) -> ast.Assign | ast.AnnAssign | None:
    """Where a parameter's value is read, and kept."""
    for node in ast.walk(file.tree):
        if (
            isinstance(node, ast.Assign | ast.AnnAssign)
            and node.value is not None
            and any(_reads(each, name) for each in ast.walk(node.value))
        ):
            return node
    return None


def _with_value(expression: ast.expr, reading: ast.AST, value: str) -> str:
    """What is kept, of the new value: the value itself, but for a period, which is worked out from it."""
    if not any(isinstance(each, ast.Div) for each in ast.walk(expression)):
        return value
    return ast.unparse(expression).replace(ast.unparse(reading), value)


def _set_on(file: NodeFile, node: ast.AST, name: str) -> bool:
    """Whether a statement stands below `if p.name == name:`."""
    for each in file.ancestors(node):
        match each:
            case ast.If(test=ast.Compare(comparators=[ast.Constant(value=str() as text)])):
                return text == name
    return False


def _timer(file: NodeFile) -> str:
    """What the timer is kept in, or shall be."""
    return kept_in if _lasts(kept_in := _kept_in(file)) else f"{file.holder}.timer"


def _kept_in(file: NodeFile) -> str:
    """What the first timer is assigned to, if by the caller of the function that makes and returns it."""
    made = file.first_timer
    if made is None:
        return ""
    maker = file.function_around(made)
    if maker is None or not isinstance(file.statement(made), ast.Return):
        return file.assigned_to(made)
    return next((into for call in file.calls(maker.name) if (into := file.assigned_to(call))), "")


def _lasts(target: str) -> bool:
    return "." in target or "[" in target


def _kept_timer(file: NodeFile, without: Sequence[Function]) -> list[Edit]:
    """The first timer, kept in an attribute."""
    made = file.first_timer
    if made is None or _lasts(_kept_in(file)) or file.function_around(made) in without:
        return []
    timer = _timer(file)
    emptied = [
        remove_lines(file.text, each.lineno)
        for each in ast.walk(file.tree)
        if isinstance(each, ast.Assign) and ast.unparse(each) == f"{timer} = None" and each.lineno > made.lineno
    ]
    return [replace_node(file.text, made, f"{timer} = {ast.unparse(made)}"), *emptied]


def is_followed(file: NodeFile, name: str) -> bool:
    """Whether the timer's callback reads a parameter from the node, or a parameter callback asks for its name."""
    callbacks = [found for kind in (ON_SET, POST_SET) if (found := registered_callback(file, kind)) is not None]
    inside = [each for callback in callbacks for each in file.reached(callback)]
    ticking = file.reached(file.tick) if file.tick is not None else []
    asked = [each for function in inside for each in ast.walk(function) if isinstance(each, ast.Compare)]
    return any(file.function_around(each) in ticking for each in readings(file, name)) or any(
        _is_text(each, name) for test in asked for each in (test.left, *test.comparators)
    )


def _made_again(made: ast.Call, each: str) -> str:
    """The call that makes the timer, with another period."""
    period, again = f"1.0 / {each}.value", ast.parse(ast.unparse(made), mode="eval").body
    assert isinstance(again, ast.Call)
    code = ast.parse(period, mode="eval").body
    if again.args:
        again.args[0] = code
    for keyword in again.keywords:
        if keyword.arg == "timer_period_sec":
            keyword.value = code
    return ast.unparse(again)


def _is_early(file: NodeFile) -> bool:
    """Whether a callback is registered before parameters are declared, and so is called before there is a timer."""
    declared = file.calls("declare_parameter", "declare_parameters")
    return any(call.lineno < each.lineno for call in file.calls(ON_SET, POST_SET) for each in declared)
