"""I1.1: next steps, worded as edits to the learner's own file. The source affects only the wording, never the verdict.

If the file already contains an edit, the next larger one is suggested, up to a rewrite of the whole program. A file
that Python cannot parse gets plain advice.
"""

from __future__ import annotations

import ast
import re

from checks.i1_1.facts import HIGHEST, LOWEST, SUGGESTED_NAME, SUGGESTED_RATE, TOPIC, TYPE
from checks.i1_1.program import whole_program
from tutor.judge.causes import parameter_slips, period_slips, slips, spinning
from tutor.judge.edits import Edit, add_import, remove_statement, replace_node
from tutor.judge.rewriting import parameters, publishing, whole
from tutor.judge.rewriting.node import NodeFile, find_in_files, node_file, started_node
from tutor.judge.source import last_name
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_RANGE = f"({LOWEST}, {HIGHEST})"
_DRAWING = ("uniform", "random", "randint", "randrange", "gauss", "normalvariate", "normal", "triangular", "choice")


def file(trace: Trace | None) -> NodeFile:
    """Parse the learner's file that was started."""
    return started_node(trace) if trace is not None else node_file("")


def draw_values(trace: Trace | None) -> str:
    """Step: draw a new random value from the range for every message."""
    read = file(trace)
    draw, imported = _draw(read)
    seeding = [
        remove_statement(read.text, statement)
        for call in read.calls("seed")
        if read.timer_callback is not None and read.function_around(call) in read.reachable_from(read.timer_callback)
        for statement in [read.statement(call)]
    ]
    return (
        read.step(
            seeding,
            [*publishing.send_data(read, draw, message_class=TYPE.rpartition("/")[2]), *imported],
            [*publishing.whole_timer_callback(read, draw), *imported] if whole.is_usual(read) else [],
            whole_program(read),
        )
        or f"draw a new value in every callback: random.uniform{_RANGE}"
    )


def diagnose_initial_value(read: NodeFile, value: float) -> Cause | None:
    """Whether a wrong value is the one with which the node starts, before it has drawn any."""
    if not read.calls(*_DRAWING):
        return None
    found = [
        constant
        for each in read.nodes
        if isinstance(each, ast.Assign) and (constant := _only_constant(each.value)) is not None
        if isinstance(constant.value, int | float) and constant.value == value
        if isinstance(each.targets[0], ast.Attribute)
    ]
    step = read.step([replace_node(read.text, found[0], str((LOWEST + HIGHEST) / 2))]) if len(found) == 1 else None
    text = f"the node starts with {value:g} (line {found[0].lineno}), and publishes it" if found else ""
    return Cause("initial value out of range", text, step) if step else None


def _only_constant(value: ast.expr) -> ast.Constant | None:
    """The constant that an attribute is set to, or that makes the message it is set to, as in Float64(data=0.0)."""
    if isinstance(value, ast.Call):
        given = [*value.args, *(each.value for each in value.keywords)]
        return given[0] if len(given) == 1 and isinstance(given[0], ast.Constant) else None
    return value if isinstance(value, ast.Constant) else None


def use_one_type(trace: Trace) -> str:
    """Step: publish only the right type on the topic."""
    read = file(trace)
    return (
        read.step(publishing.use_one_type(read, TOPIC, TYPE), whole_program(read))
        or f"publish nothing but {TYPE} on {TOPIC}"
    )


def add_publisher(trace: Trace | None) -> str:
    """Step: add a publisher, a timer, and a callback that publishes."""
    read = file(trace)
    draw, imported = _draw(read)
    edits = publishing.whole_publishing(read, TOPIC, TYPE, draw, SUGGESTED_RATE, log=SUGGESTED_NAME)
    return read.step([*edits, *imported], whole_program(read)) or ""


def make_float(trace: Trace | None) -> str:
    """Step: convert the published value to float."""
    read = file(trace)
    data = publishing.published_data(read)
    number = ast.unparse(data) if data is not None else ""
    if number and (numpy := next((alias for _, alias in read.imports if alias.name == "numpy"), None)):
        number = f"{numpy.asname or numpy.name}.ravel({number})[0]"  # it may be an array of one element
    edits = [replace_node(read.text, data, f"float({number})")] if data is not None else []
    return read.step(edits, whole_program(read)) or "make it a float first: msg.data = float(value)"


def set_timer_period(trace: Trace, name: str, unit: str = "Hz") -> str:
    """Step: derive the timer's period from a parameter that is a rate in Hz or a period in s or ms."""
    read = file(trace)
    code = {"Hz": f"1.0 / {read.value(name)}", "s": read.value(name), "ms": f"{read.value(name)} / 1000.0"}[unit]
    return read.step([*publishing.set_period(read, code), *publishing.keep_one_timer(read)], whole_program(read)) or (
        f"the timer's period is {code}, and there is one timer only"
    )


def declare_rate(trace: Trace | None, name: str) -> str:
    """Step: declare a rate parameter and derive the timer's period from it."""
    read = file(trace)
    return read.step(
        [*parameters.declare_parameter(read, name, 1.0), *publishing.set_period(read, f"1.0 / {read.value(name)}")],
        whole_program(read),
    ) or (f"self.declare_parameter('{name}', 1.0), and use its value for the timer's period")


def declare_name(trace: Trace, name: str) -> str:
    """Step: declare a parameter for the sensor's name and log it with every message."""
    read = file(trace)
    return read.step(
        [*parameters.declare_parameter(read, name, "sensor"), *publishing.log_value(read, name)], whole_program(read)
    ) or (f"self.declare_parameter('{name}', 'sensor'), and put its value into a log message")


def diagnose_name(trace: Trace, name: str) -> Cause:
    """Diagnose why the sensor's name is missing from the log messages."""
    read = file(trace)
    shows_object = any("<rclpy.parameter.Parameter object" in log.text for log in trace.logs)
    as_object = parameter_slips.diagnose_parameter_object(read, name) if shows_object else None
    cause = (
        as_object
        or find_in_files(trace, parameter_slips.diagnose_dropped_arguments)
        or _diagnose_log_level(read, name)
        or slips.diagnose_missing_f(read, [log.text for log in trace.logs])
    )
    if cause is not None:
        return cause
    draw, imported = _draw(read)
    callback = [*publishing.whole_timer_callback(read, draw, log=name), *imported] if whole.is_usual(read) else []
    step = read.step(publishing.log_value(read, name), callback, whole_program(read))
    advice = f"log it with each message: {read.name}.get_logger().info({read.value(name)})"
    return Cause("parameter ignored", f"{name} is declared, but its value is not logged", step or advice)


def find_any_step(trace: Trace) -> str:
    """Step for any fault: remove other types from the topic, or else rewrite the program.

    Return "" if Python cannot parse the file.
    """
    read = file(trace)
    return read.step(publishing.use_one_type(read, TOPIC, TYPE), whole_program(read)) or ""


def _diagnose_log_level(read: NodeFile, name: str) -> Cause | None:
    for call in read.calls("debug"):
        if isinstance(call.func, ast.Attribute) and _mentions(call, read, name):
            info = replace_node(read.text, call.func, f"{ast.unparse(call.func.value)}.info")
            if (step := read.step([info])) is not None:
                text = f"line {call.lineno}: {ast.unparse(call)}: debug messages are not shown"
                return Cause("logged at DEBUG", text, step)
    return None


def _mentions(call: ast.Call, read: NodeFile, name: str) -> bool:
    """Whether a call contains a parameter's name or the variable that holds its value; if there is none, any value."""
    kept = parameters.find_kept_value(read, name)
    if kept is None:
        return any(not isinstance(each, ast.Constant) for each in call.args)
    targets = kept.targets if isinstance(kept, ast.Assign) else [kept.target]
    return any(re.search(rf"\b{word}\b", ast.unparse(call)) for word in (name, *map(last_name, targets)) if word)


def diagnose_rate(trace: Trace, name: str, asked_hz: float) -> Cause | None:
    """Diagnose why the rate does not follow a parameter in Hz, if a single line shows it."""
    return diagnose_whole_rate(trace, name) or find_in_files(
        trace,
        parameter_slips.diagnose_dropped_arguments,
        period_slips.diagnose_second_timer,
        period_slips.diagnose_period_unit,
        period_slips.diagnose_nanoseconds,
        period_slips.diagnose_period_attribute,
        lambda read: parameter_slips.diagnose_override(read, name, whole_program(read) if read is file(trace) else []),
        lambda read: period_slips.diagnose_sleep(read, asked_hz),
        period_slips.diagnose_throttle,
        spinning.diagnose_nap_between_spins,
        lambda read: period_slips.diagnose_sleep_in_helper(read, asked_hz),
    )


def diagnose_whole_rate(trace: Trace, name: str) -> Cause | None:
    """Diagnose a rate that is cut to a whole number, so that a small one becomes 0."""
    read = file(trace)
    if (cause := find_in_files(trace, slips.diagnose_xor, period_slips.diagnose_integer_period)) is not None:
        return cause
    kept = parameters.find_kept_value(read, name)
    if kept is None or not any(
        isinstance(each, ast.Call) and isinstance(each.func, ast.Name) and each.func.id in ("int", "round")
        for each in ast.walk(kept)
    ):
        return None
    text = f"line {kept.lineno}: {ast.unparse(kept)} has no decimals: 0.5 becomes 0"
    return Cause("rate made a whole number", text, set_timer_period(trace, name))


def _draw(read: NodeFile) -> tuple[str, list[Edit]]:
    """Return an expression that draws a value, and the edits that import what it needs."""
    taken = False  # the name `random` is bound to something else
    for node in ast.walk(read.tree):
        match node:
            case ast.Import(names=names):
                found = next((alias for alias in names if alias.name == "random"), None)
                if found is not None:
                    return f"{found.asname or found.name}.uniform{_RANGE}", []
            case ast.ImportFrom(module="random", names=names):
                found = next((alias for alias in names if alias.name == "uniform"), None)
                if found is not None:
                    return f"{found.asname or found.name}{_RANGE}", []
                taken = taken or any((alias.asname or alias.name) == "random" for alias in names)
            case ast.ImportFrom(names=names):
                taken = taken or any((alias.asname or alias.name) == "random" for alias in names)
    if taken:
        return f"uniform{_RANGE}", add_import(read.text, "from random import uniform")
    return f"random.uniform{_RANGE}", add_import(read.text, "import random")
