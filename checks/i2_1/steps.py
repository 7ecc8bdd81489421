"""I2.1: next steps, worded as edits to the learner's own file. The source affects only the wording, never the verdict.

If the file already contains an edit, the next larger one is suggested, up to a rewrite of the whole program. A file
that Python cannot parse gets plain advice.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence

from checks.i2_1.facts import DEFAULTS, ENABLED, PREFIX, RATE, TOPIC, TYPE
from checks.i2_1.program import whole_program
from tutor.judge import causes
from tutor.judge.causes import parameter_slips
from tutor.judge.edits import Edit
from tutor.judge.rewriting import parameter_callbacks, parameters, publishing, whole
from tutor.judge.rewriting.node import NodeFile, find_in_files, started_node
from tutor.judge.trace import SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause


def declare_parameters(trace: Trace, names: Sequence[str]) -> str:
    """Step: declare these parameters with their defaults."""
    read = started_node(trace)
    edits = [
        edit
        for name in names
        for edit in parameters.rename_parameter(read, name, list(DEFAULTS))
        or parameters.declare_parameter(read, name, DEFAULTS[name][1])
    ]
    name = names[0]
    return (
        read.step(whole_program(read) if _reads_rate_as_text(read) else None, edits, whole_program(read))
        or f"{read.name}.declare_parameter({name!r}, {DEFAULTS[name][1]!r}) in __init__"
    )


def _reads_rate_as_text(read: NodeFile) -> bool:
    """Whether the file makes a number of a text or whole number where it reads the rate."""
    return any(
        isinstance(each, ast.Attribute) and each.attr in ("string_value", "integer_value") and RATE in ast.unparse(each)
        for each in read.nodes
    )


def add_publisher(trace: Trace) -> str:
    """Step: add a publisher, a timer, and a callback that publishes."""
    read = started_node(trace)
    data = publishing.prefixed_text(read, PREFIX)
    return (
        read.step(publishing.whole_publishing(read, TOPIC, TYPE, data, RATE, enabled=ENABLED), whole_program(read))
        or ""
    )


def use_parameter(trace: Trace, name: str, *others: str) -> str:
    """Step: let the node use the parameter's value, which each message looks up; `others`: more such parameters."""
    read = started_node(trace)
    smallest = [edit for each in (name, *others) for edit in _use_value(read, each)]
    advice = f"the timer's period is 1.0 / {RATE}" if name == RATE else f"look {name} up for each message"
    return read.step(smallest, *_larger(read, _all_callbacks)) or f"{advice}: {read.value(name)}"


def _use_value(read: NodeFile, name: str) -> list[Edit]:
    if name == RATE:
        return publishing.set_period(read, f"1.0 / {read.value(RATE)}")
    if name == PREFIX:
        return publishing.send_data(read, publishing.prefixed_text(read, PREFIX))
    return publishing.pause_while_off(read, ENABLED)


def use_parameter_later(trace: Trace, name: str) -> str:
    """Step: use a parameter's current value; rewrite the whole callback if it ignores the other parameter as well."""
    read = started_node(trace)
    others = {PREFIX, ENABLED} - {name}
    if all(parameter_callbacks.is_followed(read, other) for other in others):
        return use_parameter(trace, name)
    return read.step(*_larger(read, _timer_callback, _all_callbacks)) or use_parameter(trace, name)


def follow_changes(trace: Trace) -> str:
    """Step: let every parameter change take effect; rewrite the parameter callbacks, or else the timer's as well."""
    read = started_node(trace)
    return read.step(*_larger(read, _parameter_callbacks_and_one_timer, _all_callbacks)) or (
        "in a post-set callback: cancel the timer, and make another one with the period 1.0 / rate"
    )


def keep_timer_running(trace: Trace) -> str:
    """Step: keep the timer running whatever `enabled` is, by rewriting the timer and parameter callbacks."""
    read = started_node(trace)
    return read.step(*_larger(read, _all_callbacks)) or (
        f"let one timer run on, and only skip publish() while {ENABLED} is false"
    )


def send_once_per_tick(trace: Trace) -> str:
    """Step: publish one message per timer callback, with one timer."""
    read = started_node(trace)
    return read.step(*_larger(read, _timer_callback_and_one_timer, _all_callbacks)) or (
        f"publish one message in each callback of one timer, whose period is 1.0 / {RATE}"
    )


def cancel_old_timer(trace: Trace) -> str:
    """Step: cancel the old timer before creating a new one."""
    read = started_node(trace)
    return read.step(parameter_callbacks.cancel_old_timer(read)) or follow_changes(trace)


def remove_waits(trace: Trace, stuck: Sequence[Frame]) -> str:
    """Step: remove blocking waits from the callback that was stuck, be it the timer's or a parameter callback."""
    read = started_node(trace)
    tick = read.timer_callback
    stuck_lines = {frame.line for frame in stuck}
    if tick is not None and any(tick.lineno <= line <= (tick.end_lineno or 0) for line in stuck_lines):
        return read.step(*_larger(read, _timer_callback, _all_callbacks)) or keep_timer_running(trace)
    return follow_changes(trace)


def refuse_bad_rates(trace: Trace) -> str:
    """Step: reject bad rates before doing anything else."""
    read = started_node(trace)
    smallest = [*parameter_callbacks.remove_pre_set_callback(read), *parameter_callbacks.refuse_bad_rates(read, RATE)]
    return read.step(smallest, *_larger(read, _parameter_callbacks)) or (
        "return SetParametersResult(successful=False, reason='...') from an on-set-parameters callback"
    )


def accept_value(trace: Trace, answer: SetAnswer) -> str:
    """Step: accept a good value, in the parameter's declaration and in the callbacks."""
    read, reason = started_node(trace), answer.reason
    if "parameter list cannot be empty" in reason:
        return refuse_bad_rates(trace)
    if (causes.RCLPY_REASON.match(reason) and "Callback returned" not in reason) or "out of range" in reason:
        declaring = [
            each for n in answer.values for each in parameters.declare_parameter(read, n, DEFAULTS[n][1], plain=True)
        ]
        return (
            read.step(declaring, *_larger(read, _parameter_callbacks))
            or "declare it in __init__ with its default, and nothing more"
        )
    if "Callback returned" in reason and parameter_callbacks.is_coroutine(read):
        return read.step(parameter_callbacks.without_async(read)) or check_all_first(trace)
    return check_all_first(trace)


def check_all_first(trace: Trace) -> str:
    """Step: check all values before applying any."""
    read = started_node(trace)
    return read.step(*_larger(read, _parameter_callbacks, _all_callbacks)) or (
        "only validate in the on-set callback; apply in a post-set callback (add_post_set_parameters_callback)"
    )


def check_at_start(trace: Trace) -> str:
    """Step: check the rate at start-up, with an error message that names the parameter."""
    read = started_node(trace)
    return read.step(parameters.check_at_start(read, RATE), whole_program(read)) or (
        f"check it after declaring it, and log an error that names {RATE}"
    )


def diagnose_override(trace: Trace, name: str) -> Cause | None:
    """Diagnose code that overrides the value given to a parameter at start-up."""
    started = started_node(trace)
    return find_in_files(
        trace,
        lambda file: parameter_slips.diagnose_override(file, name, whole_program(file) if file is started else []),
    )


def whole_program_step(trace: Trace) -> str:
    """Step for any fault: rewrite the whole program. Return "" if Python cannot parse the file."""
    read = started_node(trace)
    return read.step(whole_program(read)) or ""


def _larger(read: NodeFile, *parts: Callable[[NodeFile], list[Edit]]) -> list[list[Edit]]:
    """The larger edits: these parts, if the node is regular enough for them to be safe, then the whole program."""
    return [*(part(read) for part in parts if whole.is_usual(read)), whole_program(read)]


def _parameter_callbacks(read: NodeFile) -> list[Edit]:
    return parameter_callbacks.follow_parameters(read, RATE, PREFIX, ENABLED)


def _timer_callback(read: NodeFile) -> list[Edit]:
    return publishing.whole_timer_callback(read, publishing.prefixed_text(read, PREFIX), enabled=ENABLED)


def _all_callbacks(read: NodeFile) -> list[Edit]:
    return [*_parameter_callbacks(read), *publishing.keep_one_timer(read), *_timer_callback(read)]


def _parameter_callbacks_and_one_timer(read: NodeFile) -> list[Edit]:
    return [*_parameter_callbacks(read), *publishing.keep_one_timer(read)]


def _timer_callback_and_one_timer(read: NodeFile) -> list[Edit]:
    return [*_timer_callback(read), *publishing.keep_one_timer(read)]
