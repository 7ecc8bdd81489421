"""Parameter callbacks: which kind may refuse, and when each is called."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import Function, NodeFile, argument, calls_in, last_name
from tutor.source.parameters import ON_SET, POST_SET, may_refuse, readings, registered_callback

_UNSEEN = (Symptom.BAD_VALUE_ACCEPTED, Symptom.WRONG_RATE, Symptom.CHANGE_IGNORED)


@mistake(
    "refused-too-late",
    explains=_UNSEEN,
    says="{line} registers {function} to be called once the value is set, when it can no longer refuse it: {code}",
    do="Register it as an on-set callback, which is asked beforehand.",
)
def refused_too_late(case: Case) -> Iterator[Found]:
    """A post-set callback tries to refuse a value.

    Post-set callbacks are told about values that are already stored, and what they return is ignored. On-set callbacks
    are asked beforehand, and can refuse.

    Bad:

        def __init__(self):
            self.add_post_set_parameters_callback(self.check)

        def check(self, parameters):
            return SetParametersResult(successful=False, reason='too loud')

    Good:

        def __init__(self):
            self.add_on_set_parameters_callback(self.check)

        def check(self, parameters):
            return SetParametersResult(successful=False, reason='too loud')

    See it: `ros2 param set NODE NAME BAD_VALUE` says "Set parameter successful".
    """
    for file in case.files:
        for call in file.calls(POST_SET):
            function = file.function(argument(call, "callback"))
            if function is not None and may_refuse(file, function) and not calls_in(function, "get_parameter"):
                yield found(file, call, function=function.name)


@mistake(
    "value-taken-over-before-it-is-checked",
    explains=(Symptom.BAD_VALUE_ACCEPTED,),
    says="{function} ({line}) applies the values before {other} refuses them: the callback added last is called first",
    do="Only check in on-set callbacks, and apply the values in a post-set callback.",
)
def callback_order(case: Case) -> Iterator[Found]:
    """One on-set callback applies what another refuses.

    rclpy asks the on-set callbacks in turn, the one added last first, until one refuses. A callback that also applies
    the values has done so by then, and the node works with values that its parameters do not have.

    Bad:

        def __init__(self):
            self.add_on_set_parameters_callback(self.check)
            self.add_on_set_parameters_callback(self.apply)

        def check(self, parameters):
            return SetParametersResult(successful=False, reason='too loud')

        def apply(self, parameters):
            self.volume = parameters[0].value
            return SetParametersResult(successful=True)

    Good:

        def __init__(self):
            self.add_on_set_parameters_callback(self.check)
            self.add_post_set_parameters_callback(self.apply)

        def check(self, parameters):
            return SetParametersResult(successful=False, reason='too loud')

        def apply(self, parameters):
            self.volume = parameters[0].value

    See it: `ros2 param set` with a bad value, then what the node does.
    """
    for file in case.files:
        functions = [file.function(argument(call, "callback")) for call in file.calls(ON_SET)]
        refusing = [function for function in functions if may_refuse(file, function)]
        applying = [function for function in functions if function is not None and function not in refusing]
        if refusing and refusing[0] is not None and applying and None not in functions:
            yield found(file, applying[0], function=applying[0].name, other=refusing[0].name)


@mistake(
    "callback-not-registered",
    explains=(*_UNSEEN, Symptom.REFUSED),
    says="{what}",
    do="Register the callback once, in __init__, by its name and without calling it.",
)
def not_registered(case: Case) -> Iterator[Found]:
    """A parameter callback is never called.

    A function becomes a parameter callback when its name is given to add_on_set_parameters_callback (or
    add_post_set_…). With parentheses, it is called at once, and what it returns is registered instead.

    Bad:

        def __init__(self):
            self.add_on_set_parameters_callback(self.check())

        def check(self):
            return SetParametersResult(successful=True)

    Good:

        def __init__(self):
            self.add_on_set_parameters_callback(self.check)

        def check(self, parameters):
            return SetParametersResult(successful=True)

    See it: log a line in the callback, and set a parameter.
    """
    for file in case.files:
        yield from _unregistered(file)


def _unregistered(file: NodeFile) -> Iterator[Found]:
    calls = file.calls(ON_SET, POST_SET)
    for call in calls:
        given, around = argument(call, "callback"), file.function_around(call)
        code = f"line {call.lineno}"
        if isinstance(given, ast.Call) and file.function(given.func) is not None:
            yield found(file, call, what=f"{code} calls the callback at once, and registers what it returns")
        elif around is not None and file.setup is not None and not _is_reached(file, around):
            yield found(file, call, what=f"{code} registers it in {around.name}, which nothing calls at the start")
    used = {node.attr for node in file.nodes if isinstance(node, ast.Attribute)}
    used |= {node.id for node in file.nodes if isinstance(node, ast.Name)}
    used |= {node.value for node in file.nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    for function in file.functions:
        if function.name not in used and not function.decorator_list and _is_parameter_callback(function):
            yield found(file, function, what=f"nothing registers {function.name} (line {function.lineno})")


def _is_parameter_callback(function: Function) -> bool:
    """Whether a function returns a SetParametersResult, or looks at the names and values of a list of parameters."""
    if "SetParametersResult(" in ast.unparse(function):
        return True
    given = [parameter.arg for parameter in function.args.args if parameter.arg not in ("self", "cls")]
    for node in ast.walk(function):
        match node:
            case ast.For(target=ast.Name(id=variable), iter=ast.Name(id=many)) if given == [many]:
                asked = {
                    inner.attr
                    for inner in ast.walk(node)
                    if isinstance(inner, ast.Attribute)
                    and isinstance(inner.value, ast.Name)
                    and inner.value.id == variable
                }
                return {"name", "value"} <= asked
    return False


def _is_reached(file: NodeFile, function: Function) -> bool:
    """Whether the setup or the main program calls a function, directly or indirectly."""
    callers = [around for call in file.calls(function.name) if (around := file.function_around(call)) is not None]
    starting = [file.setup, *file.functions_named("main")]
    reached = [inner for start in starting if start is not None for inner in file.reachable_from(start)]
    at_module_level = len(callers) < len(file.calls(function.name))
    return function in reached or at_module_level or any(caller in reached for caller in callers)


@mistake(
    "callback-defined-twice",
    explains=_UNSEEN,
    says="{name} is defined in line {first} and again in {line}: the second replaces the first, which is never called",
    do="Rename one of the two, or merge them.",
)
def defined_twice(case: Case) -> Iterator[Found]:
    """A callback is defined twice.

    In a class, a second method of the same name silently replaces the first.

    Bad:

        def __init__(self):
            self.add_on_set_parameters_callback(self.check)

        def check(self, parameters):
            return SetParametersResult(successful=parameters[0].value < 11)

        def check(self, parameters):
            return SetParametersResult(successful=True)

    Good:

        def __init__(self):
            self.add_on_set_parameters_callback(self.check)

        def check(self, parameters):
            return SetParametersResult(successful=parameters[0].value < 11)

    See it: a linter says "redefinition of unused".
    """
    for file in case.files:
        for call in file.calls(ON_SET, POST_SET):
            given = argument(call, "callback")
            same = file.functions_named(ast.unparse(given).rpartition(".")[2]) if given is not None else []
            if len(same) > 1 and len({file.class_of(function) for function in same}) == 1:
                yield found(file, same[-1], name=same[-1].name, first=same[0].lineno)


@mistake(
    "old-value-used",
    explains=(Symptom.WRONG_RATE, Symptom.CHANGE_IGNORED),
    says="{line} still reads the old value, since on-set callbacks are called before the new one is stored: {code}",
    do="Take the new value from the callback's argument, or read it in a post-set callback.",
    example=in_run(Symptom.CHANGE_IGNORED, parameter="volume"),
)
def old_value_used(case: Case) -> Iterator[Found]:
    """An on-set callback reads the old value.

    An on-set callback is asked whether a change is fine; until it has agreed, the node has the old value. The new one
    is in the list that the callback is given.

    Bad:

        def __init__(self):
            self.add_on_set_parameters_callback(self.follow)

        def follow(self, parameters):
            self.volume = self.get_parameter('volume').value
            return SetParametersResult(successful=True)

    Good:

        def __init__(self):
            self.add_post_set_parameters_callback(self.follow)

        def follow(self, parameters):
            self.volume = self.get_parameter('volume').value

    See it: set the parameter twice: the node is always one value behind.
    """
    name = case.about("parameter", "")
    for file in case.files:
        checker = registered_callback(file, ON_SET)
        if checker is not None:
            timers = [file.function(argument(timer, "callback")) for timer in file.timers]
            inside = [function for function in file.reachable_from(checker) if function not in timers]
            used = {node.attr for function in inside for node in ast.walk(function) if isinstance(node, ast.Attribute)}
            inside += [function for function in file.functions if function.name in used and _is_property(function)]
            yield from (found(file, read) for read in readings(file, name) if file.function_around(read) in inside)


def _is_property(function: Function) -> bool:
    return any(last_name(decorator) in ("property", "cached_property") for decorator in function.decorator_list)
