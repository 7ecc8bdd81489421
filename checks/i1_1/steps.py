"""I1.1: next steps as edits of the learner's own file. The source only chooses the words.

Where an edit is in the file already, a larger one follows, down to the whole program; plain words are left for a file
that Python cannot read.
"""

from __future__ import annotations

import ast
import re

from checks.i1_1.facts import HIGHEST, LOWEST, SUGGESTED_NAME, SUGGESTED_RATE, TOPIC, TYPE
from checks.i1_1.program import whole_program
from tutor.judge.causes import parameter_slips, period_slips
from tutor.judge.edits import Edit, add_import, remove_statement, replace_node
from tutor.judge.rewriting import parameters, publishing, whole
from tutor.judge.rewriting.node import NodeFile, node_file, started_node
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause

_RANGE = f"({LOWEST}, {HIGHEST})"


def file(trace: Trace | None) -> NodeFile:
    """The learner's file that was started."""
    return started_node(trace) if trace is not None else node_file("")


def draw_values(trace: Trace | None) -> str:
    """Every message has a new value, drawn at random from the range."""
    read = file(trace)
    draw, imported = _draw(read)
    seeding = [
        remove_statement(read.text, statement)
        for call in read.calls("seed")
        if read.tick is not None and read.function_around(call) in read.reached(read.tick)
        for statement in [read.statement(call)]
    ]
    return (
        read.step(
            seeding,
            [*publishing.send_data(read, draw), *imported],
            [*publishing.whole_timer_callback(read, draw), *imported] if whole.is_usual(read) else [],
            whole_program(read),
        )
        or f"draw a new value in every callback: random.uniform{_RANGE}"
    )


def use_one_type(trace: Trace) -> str:
    """Nothing but the right type on the topic."""
    read = file(trace)
    return (
        read.step(publishing.use_one_type(read, TOPIC, TYPE), whole_program(read))
        or f"publish nothing but {TYPE} on {TOPIC}"
    )


def add_publisher(trace: Trace | None) -> str:
    """A publisher, a timer and its callback that sends the messages."""
    read = file(trace)
    draw, imported = _draw(read)
    edits = publishing.whole_publishing(read, TOPIC, TYPE, draw, SUGGESTED_RATE, log=SUGGESTED_NAME)
    return read.step([*edits, *imported], whole_program(read)) or ""


def make_float(trace: Trace | None) -> str:
    """What is put into the message is a float."""
    read = file(trace)
    data = publishing.published_data(read)
    edits = [replace_node(read.text, data, f"float({ast.unparse(data)})")] if data is not None else []
    return read.step(edits, whole_program(read)) or "make it a float first: msg.data = float(value)"


def set_timer_period(trace: Trace, name: str, unit: str = "Hz") -> str:
    """The timer's period follows a parameter, which is a rate in Hz, or a period in s or ms."""
    read = file(trace)
    code = {"Hz": f"1.0 / {read.value(name)}", "s": read.value(name), "ms": f"{read.value(name)} / 1000.0"}[unit]
    return read.step([*publishing.set_period(read, code), *publishing.keep_one_timer(read)], whole_program(read)) or (
        f"the timer's period is {code}, and there is one timer only"
    )


def declare_rate(trace: Trace | None, name: str) -> str:
    """There is a rate parameter, and the timer's period follows it."""
    read = file(trace)
    return read.step(
        [*parameters.declare_parameter(read, name, 1.0), *publishing.set_period(read, f"1.0 / {read.value(name)}")],
        whole_program(read),
    ) or (f"self.declare_parameter('{name}', 1.0), and use its value for the timer's period")


def declare_name(trace: Trace, name: str) -> str:
    """There is a parameter for the sensor's name, and it is logged with every message."""
    read = file(trace)
    return read.step(
        [*parameters.declare_parameter(read, name, "sensor"), *publishing.log_value(read, name)], whole_program(read)
    ) or (f"self.declare_parameter('{name}', 'sensor'), and put its value into a log message")


def diagnose_name(trace: Trace, name: str) -> Cause:
    """What keeps the sensor's name from the log messages."""
    read = file(trace)
    if (cause := _diagnose_log_level(read) or _diagnose_missing_f(read)) is not None:
        return cause
    draw, imported = _draw(read)
    ticking = [*publishing.whole_timer_callback(read, draw, log=name), *imported] if whole.is_usual(read) else []
    step = read.step(publishing.log_value(read, name), ticking, whole_program(read))
    words = f"log it with each message: {read.name}.get_logger().info({read.value(name)})"
    return Cause("parameter ignored", f"{name} is declared, but its value is not logged", step or words)


def anything(trace: Trace) -> str:
    """What there is of another type on the topic goes, or else the program as a whole, whatever its fault is.

    Empty where Python cannot read the file.
    """
    read = file(trace)
    return read.step(publishing.use_one_type(read, TOPIC, TYPE), whole_program(read)) or ""


def _diagnose_log_level(read: NodeFile) -> Cause | None:
    for call in read.calls("debug"):
        if isinstance(call.func, ast.Attribute):
            info = replace_node(read.text, call.func, f"{ast.unparse(call.func.value)}.info")
            if (step := read.step([info])) is not None:
                text = f"line {call.lineno}: {ast.unparse(call)}: debug messages are not shown"
                return Cause("logged at DEBUG", text, step)
    return None


def _diagnose_missing_f(read: NodeFile) -> Cause | None:
    for call in read.calls("info", "warning", "warn", "error"):
        match call.args:
            case [ast.Constant(value=str() as said) as text, *_] if re.search(r"\{(?:self\.)?\w+", said):
                if (step := read.step([replace_node(read.text, text, f"f{said!r}")])) is not None:
                    words = f"line {call.lineno}: {ast.unparse(call)} logs these words as they are, not the value"
                    return Cause("no f in front of the text", words, step)
    return None


def diagnose_rate(trace: Trace, name: str, asked_hz: float) -> Cause | None:
    """What keeps the rate from being what a parameter, which is read in Hz, says, as far as one line tells it."""
    read = file(trace)
    return (
        diagnose_whole_rate(trace, name)
        or period_slips.diagnose_period_unit(read)
        or parameter_slips.diagnose_override(read, name, whole_program(read))
        or period_slips.diagnose_sleep(read, asked_hz)
    )


def diagnose_whole_rate(trace: Trace, name: str) -> Cause | None:
    """Whether a rate is cut to a whole number, so that a small one becomes 0."""
    read = file(trace)
    if (cause := period_slips.diagnose_integer_period(read)) is not None:
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
    """The code that draws a value, and the import that it needs."""
    taken = False
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
