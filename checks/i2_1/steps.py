"""I2.1: next steps as edits of the learner's own file. The source only chooses the words.

Where an edit is in the file already, a larger one follows, down to the whole program; plain words are left for a file
that Python cannot read.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from checks.i2_1.facts import DEFAULTS, ENABLED, PREFIX, RATE, TOPIC, TYPE
from checks.i2_1.program import whole_program
from tutor.judge import causes
from tutor.judge.causes import parameter_slips
from tutor.judge.edits import Edit
from tutor.judge.rewriting import parameters, publishing, whole
from tutor.judge.rewriting.node import NodeFile, started_node
from tutor.judge.trace import SetAnswer, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause


def declare_parameters(trace: Trace, names: Sequence[str]) -> str:
    """These parameters are declared with their defaults."""
    read = started_node(trace)
    edits = [
        edit
        for name in names
        for edit in parameters.rename_parameter(read, name, list(DEFAULTS))
        or parameters.declare_parameter(read, name, DEFAULTS[name][1])
    ]
    name = names[0]
    return (
        read.step(edits, whole_program(read))
        or f"{read.name}.declare_parameter({name!r}, {DEFAULTS[name][1]!r}) in __init__"
    )


def add_publisher(trace: Trace) -> str:
    """A publisher, a timer and its callback that sends the messages."""
    read = started_node(trace)
    data = publishing.text_with(read, PREFIX)
    return (
        read.step(publishing.whole_publishing(read, TOPIC, TYPE, data, RATE, enabled=ENABLED), whole_program(read))
        or ""
    )


def use_parameter(trace: Trace, name: str) -> str:
    """What the node does follows the parameter: each message looks its value up."""
    read = started_node(trace)
    if name == RATE:
        first = publishing.set_period(read, f"1.0 / {read.value(RATE)}")
    elif name == PREFIX:
        first = publishing.send_data(read, publishing.text_with(read, PREFIX))
    else:
        first = publishing.waiting_while_off(read, ENABLED)
    words = f"the timer's period is 1.0 / {RATE}" if name == RATE else f"look {name} up for each message"
    return read.step(first, *_larger(read, _whole)) or f"{words}: {read.value(name)}"


def use_parameter_later(trace: Trace, name: str) -> str:
    """As `use_parameter`, while the node runs: the whole callback, where the other one has no effect either."""
    read = started_node(trace)
    others = {PREFIX, ENABLED} - {name}
    if all(parameters.is_followed(read, other) for other in others):
        return use_parameter(trace, name)
    return read.step(*_larger(read, _ticking, _whole)) or use_parameter(trace, name)


def follow_changes(trace: Trace) -> str:
    """Every change of a parameter takes effect: its callbacks are rewritten, or else the timer's, too."""
    read = started_node(trace)
    return read.step(*_larger(read, _following_by_one, _whole)) or (
        "in a post-set callback: cancel the timer, and make another one with the period 1.0 / rate"
    )


def keep_timer_running(trace: Trace) -> str:
    """The timer goes on, whatever `enabled` says: the timer's callback and those of the parameters are rewritten."""
    read = started_node(trace)
    return read.step(*_larger(read, _whole)) or (
        f"let one timer run on, and only skip publish() while {ENABLED} is false"
    )


def send_once_per_tick(trace: Trace) -> str:
    """One message for each call of the timer's callback, by one timer."""
    read = started_node(trace)
    return read.step(*_larger(read, _ticking_by_one, _whole)) or (
        f"publish one message in each callback of one timer, whose period is 1.0 / {RATE}"
    )


def cancel_old_timer(trace: Trace) -> str:
    """The old timer is cancelled before there is a new one."""
    read = started_node(trace)
    return read.step(parameters.cancel_old_timer(read)) or follow_changes(trace)


def remove_waits(trace: Trace, stuck: Sequence[Frame]) -> str:
    """Nothing waits in the callbacks of the timer or of the parameters, whichever it was."""
    read = started_node(trace)
    tick = read.tick
    here = {frame.line for frame in stuck}
    if tick is not None and any(tick.lineno <= line <= (tick.end_lineno or 0) for line in here):
        return read.step(*_larger(read, _ticking, _whole)) or keep_timer_running(trace)
    return follow_changes(trace)


def refuse_bad_rates(trace: Trace) -> str:
    """Bad rates are refused, before anything else is done."""
    read = started_node(trace)
    first = [*parameters.remove_pre_set_callback(read), *parameters.refuse_bad_rates(read, RATE)]
    return read.step(first, *_larger(read, _following)) or (
        "return SetParametersResult(successful=False, reason='...') from an on-set-parameters callback"
    )


def accept_value(trace: Trace, answer: SetAnswer) -> str:
    """A good value is accepted: the declaration leaves it free, and so do the callbacks."""
    read, reason = started_node(trace), answer.reason
    if "parameter list cannot be empty" in reason:
        return refuse_bad_rates(trace)
    if (causes.RCLPY_REASON.match(reason) and "Callback returned" not in reason) or "out of range" in reason:
        declaring = [
            each for n in answer.values for each in parameters.declare_parameter(read, n, DEFAULTS[n][1], plain=True)
        ]
        return (
            read.step(declaring, *_larger(read, _following))
            or "declare it in __init__ with its default, and nothing more"
        )
    return check_all_first(trace)


def check_all_first(trace: Trace) -> str:
    """All values are checked before one takes effect."""
    read = started_node(trace)
    return read.step(*_larger(read, _following, _whole)) or (
        "only validate in the on-set callback; apply in a post-set callback (add_post_set_parameters_callback)"
    )


def checked_at_start(trace: Trace) -> str:
    """A bad rate that the node is started with is found by the parameter's name."""
    read = started_node(trace)
    return read.step(parameters.check_at_start(read, RATE), whole_program(read)) or (
        f"check it after declaring it, and log an error that names {RATE}"
    )


def diagnose_override(trace: Trace, name: str) -> Cause | None:
    """Whether the code itself gives the parameter another value than the one of the start."""
    read = started_node(trace)
    return parameter_slips.diagnose_override(read, name, whole_program(read))


def whole_program_step(trace: Trace) -> str:
    """The program as a whole, whatever its fault is; empty where Python cannot read the file."""
    read = started_node(trace)
    return read.step(whole_program(read)) or ""


def _larger(read: NodeFile, *parts: Callable[[NodeFile], list[Edit]]) -> list[list[Edit]]:
    """These parts, where it is sure what they do to the node, and the whole program."""
    return [*(part(read) for part in parts if whole.is_usual(read)), whole_program(read)]


def _following(read: NodeFile) -> list[Edit]:
    return parameters.follow_parameters(read, RATE, PREFIX, ENABLED)


def _ticking(read: NodeFile) -> list[Edit]:
    return publishing.whole_timer_callback(read, publishing.text_with(read, PREFIX), enabled=ENABLED)


def _whole(read: NodeFile) -> list[Edit]:
    return [*_following(read), *publishing.keep_one_timer(read), *_ticking(read)]


def _following_by_one(read: NodeFile) -> list[Edit]:
    return [*_following(read), *publishing.keep_one_timer(read)]


def _ticking_by_one(read: NodeFile) -> list[Edit]:
    return [*_ticking(read), *publishing.keep_one_timer(read)]
