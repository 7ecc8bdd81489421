"""Declaring parameters: whether, with which type and default, and how a value given at start-up gets there."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.ros_model import Parameter
from tutor.source import NodeFile, argument, called_name, values_of
from tutor.source.parameters import DECLARE, constants

_RATE = r"(^|_)(?i:rate|freq\w*|hz|hertz)(_|$)|[a-z]Rate$"
_START = (Symptom.CHANGE_IGNORED, Symptom.WRONG_RATE, Symptom.NOT_LOGGED)


def declaration(case: Case, name: object) -> Found:
    """The place where a parameter is declared; without a place if unknown."""
    for file in case.files:
        for call in file.calls(*DECLARE):
            if name in constants([call]):
                return found(file, call)
    return Found()


def _placed(case: Case, name: object, **words: object) -> Found:
    at = declaration(case, name)
    where = f" (line {at.line})" if at.line else ""
    return Found({"name": name, "where": where, **words}, at.file, at.line, at.code)


@mistake(
    "integer-parameter",
    explains=(Symptom.NOT_DECLARED, Symptom.REFUSED),
    evidence=Evidence.RUN,
    says="{name} is an integer, since its default is a whole number{where}, and takes no value with decimals",
    do="Give it a default with a decimal point.",
    remark="{name} is an integer, as its default is one: {name}:=5.0 ends the node at its start. "
    "Give it a default with a decimal point.",
    example=in_run(
        Symptom.NOT_DECLARED,
        parameter="blink_rate",
        type="double",
        found=Parameter("/node", "blink_rate", "integer", 2),
    ),
)
def integer_parameter(case: Case) -> Iterator[Found]:
    """A parameter is an integer where decimals are needed.

    The type of a parameter is the type of its default, and never changes: 1 makes an integer, 1.0 a double. Neither
    takes a value of the other type, so 0.5 is refused, or ends the node when it is given at start-up.

    Bad:

        self.declare_parameter('blink_rate', 2)

    Good:

        self.declare_parameter('blink_rate', 2.0)

    See it: `ros2 param describe NODE NAME`.

    Lesson: i2.1, on the types of parameters.
    """
    if case.passed:
        yield from _integer_rates(case.file)
    name, given, wanted = case.about("parameter"), case.about("found"), case.about("type")
    if given is not None and (wanted, given.type) == ("double", "integer"):
        yield _placed(case, name)
    answer = case.about("answer")
    if answer is not None and "expected 'Type.INTEGER' got 'Type.DOUBLE'" in answer.reason:
        yield _placed(case, next(iter(answer.values)))


def _integer_rates(file: NodeFile) -> Iterator[Found]:
    """The parameters that are declared as integers, and are rates by their names."""
    declared: list[tuple[ast.Call, ast.expr | None, ast.expr | None]] = [
        (call, argument(call, "name"), argument(call, "value"))
        for call in file.calls("declare_parameter")
        if argument(call, "descriptor") is None
    ]
    for call in file.calls("declare_parameters"):
        for node in ast.walk(call):
            match node:
                case ast.Tuple(elts=[first, second]) | ast.List(elts=[first, second]):
                    declared.append((call, first, second))
    for call, name, value in declared:
        given = [value] if not isinstance(value, ast.Name) else values_of(value.id, file.tree)
        # True is an int as well, but no number.
        is_integer = bool(given) and all(
            isinstance(expression, ast.Constant) and type(expression.value) is int for expression in given
        )
        if is_integer and isinstance(name, ast.Constant) and re.search(_RATE, str(name.value)):
            yield found(file, value if value is not None else call, name=name.value)


_NOT_SET = "not set"
"""The type of a parameter without a value."""

_WRONG_TYPE = re.compile(r"Wrong parameter type, expected 'Type\.(?P<declared>\w+)' got 'Type\.(?P<set>\w+)'")
_TYPES = {"BOOL": "boolean"}
"""Types of parameters that rclpy calls by another name than `ros2 param describe`."""


@mistake(
    "wrong-parameter-type",
    explains=(Symptom.NOT_DECLARED, Symptom.REFUSED),
    evidence=Evidence.RUN,
    says="{name} is of type {given}, not {wanted}{where}: the type of the default is the type of the parameter",
    do="Give it a default of the type {wanted}.",
    example=in_run(
        Symptom.NOT_DECLARED, parameter="muted", type="boolean", found=Parameter("/node", "muted", "string", "no")
    ),
)
def wrong_parameter_type(case: Case) -> Iterator[Found]:
    """A parameter has the wrong type.

    A parameter gets its type from its default: 'true' in quotation marks is a string, True a boolean; 1 is an integer,
    1.0 a double. Values of another type are refused.

    Bad:

        self.declare_parameter('muted', 'false')

    Good:

        self.declare_parameter('muted', False)

    See it: `ros2 param describe NODE NAME`.
    """
    name, given, wanted = case.about("parameter"), case.about("found"), case.about("type")
    if given is not None and wanted is not None and given.type not in (wanted, _NOT_SET):
        yield _placed(case, name, given=given.type, wanted=wanted)
    answer = case.about("answer")
    if answer is not None and (refused := _WRONG_TYPE.search(answer.reason)):
        declared, wanted = (_TYPES.get(kind, kind.lower()) for kind in refused.group("declared", "set"))
        yield _placed(case, name, given=declared, wanted=wanted)


@mistake(
    "wrong-default",
    explains=(Symptom.NOT_DECLARED,),
    evidence=Evidence.RUN,
    says="{name} begins {given}, not as {wanted}{where}",
    do="Declare it with the default that is asked for.",
    example=in_run(
        Symptom.NOT_DECLARED,
        parameter="volume",
        type="integer",
        default=5,
        found=Parameter("/node", "volume", "integer", 7),
    ),
)
def wrong_default(case: Case) -> Iterator[Found]:
    """A parameter has the wrong default.

    The default is the value of a parameter that nobody has set. It is the second argument of declare_parameter; a value
    that the node itself sets afterwards counts as well.

    Bad:

        self.declare_parameter('volume', 70)

    Good:

        self.declare_parameter('volume', 7)

    See it: `ros2 param get NODE NAME` right after the start.
    """
    name, given, default = case.about("parameter"), case.about("found"), case.about("default")
    if given is None or default is None:
        return
    if given.type == _NOT_SET:
        yield _placed(case, name, given="without a value", wanted=_shown(default))
    elif given.type == case.about("type") and given.value != default:
        yield _placed(case, name, given=f"as {_shown(given.value)}", wanted=_shown(default))


def _shown(value: object) -> str:
    """A value as it is written on the command line."""
    return str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, str) else str(value)


@mistake(
    "parameter-declared-under-another-name",
    explains=(Symptom.NOT_DECLARED,),
    says="{line} declares {given}, but the name asked for is {wanted}: {code}",
    do="Use exactly the name {wanted}, here and where it is read.",
    example=in_run(Symptom.NOT_DECLARED, parameter="volume", type="integer"),
)
def declared_under_another_name(case: Case) -> Iterator[Found]:
    """A parameter is declared under another name.

    Parameter names are compared letter by letter, underscores and capitals included. A value for a name that was not
    declared is refused, or, at start-up, ignored.

    Bad:

        self.declare_parameter('Volume', 7)

    Good:

        self.declare_parameter('volume', 7)

    See it: `ros2 param list NODE`.
    """
    wanted = case.about("parameter")
    if wanted is None or case.about("found") is not None:
        return
    plain = str(wanted).replace("_", "").lower()
    for file in case.files:
        names = [(call, argument(call, "name")) for call in file.calls("declare_parameter")]
        if any(isinstance(name, ast.Constant) and name.value == wanted for _, name in names):
            return
        for call, name in names:
            if isinstance(name, ast.Constant) and isinstance(name.value, str):
                other = name.value.replace("_", "").replace("-", "").lower()
                if other in plain or plain in other:
                    yield found(file, call, given=name.value, wanted=wanted)


@mistake(
    "arguments-left-out",
    explains=(*_START, Symptom.WRONG_NAMES),
    says="{line} keeps the command line's arguments from the node, and with them what is set and renamed there: {code}",
    do="Let rclpy take the command line's arguments itself.",
)
def dropped_arguments(case: Case) -> Iterator[Found]:
    """A node does not get the arguments from its command line.

    rclpy.init() reads sys.argv itself. With an empty list, only a part of sys.argv, or use_global_arguments=False, what
    follows --ros-args is lost: parameters, remappings, the node's name.

    Bad:

        rclpy.init(args=[])

    Good:

        rclpy.init()

    See it: `ros2 run PACKAGE NODE --ros-args -p NAME:=VALUE`, then `ros2 param get NODE NAME`.
    """
    for file in case.files:
        for call in file.calls("init", "__init__", "Node", "create_node", *file.node_classes):
            given = next((keyword.value for keyword in call.keywords if keyword.arg == "use_global_arguments"), None)
            drops = called_name(call) == "init" and _has_no_ros_arguments(file, argument(call, "args"))
            if drops or (given is not None and ast.unparse(given) == "False"):
                yield found(file, call)


def _has_no_ros_arguments(file: NodeFile, given: ast.expr | None) -> bool:
    """Whether a list is empty, or the ROS arguments have been taken out of it, or out of what it is assigned."""
    if given is None:
        return False
    function = file.function_around(given)
    assigned: list[ast.expr] = []
    if isinstance(given, ast.Name):
        assigned = values_of(given.id, function or file.tree)
        if function is not None and not assigned:
            names = [parameter.arg for parameter in function.args.args]
            defaults = dict(zip(reversed(names), reversed(function.args.defaults), strict=False))
            assigned = [defaults[given.id]] if given.id in defaults else []
    values = [given, *assigned]
    if any(isinstance(value, ast.List | ast.Tuple) and not value.elts for value in values):
        return True
    parts = [node for value in values for node in ast.walk(value)]
    return any(_leaves_out_arguments(node) for node in parts)


def _leaves_out_arguments(node: ast.AST) -> bool:
    """Whether this is a part of sys.argv that leaves out more than the name of the program."""
    match node:
        case ast.Call() if called_name(node) == "remove_ros_args":
            return True
        case ast.Subscript(value=ast.Attribute(attr="argv"), slice=ast.Slice(lower=lower, upper=upper, step=None)):
            return upper is not None or (isinstance(lower, ast.Constant) and lower.value not in (None, 0, 1))
    return False
