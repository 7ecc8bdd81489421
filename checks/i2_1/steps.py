"""I2.1: next steps as edits of the learner's own file. The source only chooses the words.

Where an edit is in the file already, a larger one follows, down to the whole program; plain words are left for a file
that Python cannot read.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from checks.i2_1.facts import DEFAULTS, ENABLED, PREFIX, RATE, TOPIC, TYPE
from checks.i2_1.program import program
from tutor.judge import causes
from tutor.judge.edits import Edit
from tutor.judge.rewriting import parameters, publishing, whole
from tutor.judge.rewriting.node import NodeFile, started
from tutor.judge.trace import SetAnswer, Trace
from tutor.judge.tracebacks import Frame


def declared(trace: Trace, names: Sequence[str]) -> str:
    """These parameters are declared with their defaults."""
    read = started(trace)
    edits = [
        edit
        for name in names
        for edit in parameters.renamed(read, name, list(DEFAULTS)) or parameters.declared(read, name, DEFAULTS[name][1])
    ]
    name = names[0]
    return (
        read.step(edits, program(read)) or f"{read.name}.declare_parameter({name!r}, {DEFAULTS[name][1]!r}) in __init__"
    )


def published(trace: Trace) -> str:
    """A publisher, a timer and its callback that sends the messages."""
    read = started(trace)
    data = publishing.text_with(read, PREFIX)
    return read.step(publishing.publishing(read, TOPIC, TYPE, data, RATE, enabled=ENABLED), program(read)) or ""


def heeded(trace: Trace, name: str) -> str:
    """What the node does follows the parameter: each message looks its value up."""
    read = started(trace)
    if name == RATE:
        first = publishing.period(read, f"1.0 / {read.value(RATE)}")
    elif name == PREFIX:
        first = publishing.sending(read, publishing.text_with(read, PREFIX))
    else:
        first = publishing.waiting_while_off(read, ENABLED)
    words = f"the timer's period is 1.0 / {RATE}" if name == RATE else f"look {name} up for each message"
    return read.step(first, *_larger(read, _whole)) or f"{words}: {read.value(name)}"


def heeded_later(trace: Trace, name: str) -> str:
    """As `heeded`, while the node runs: the whole callback, where it does not follow the other parameter either."""
    read = started(trace)
    others = {PREFIX, ENABLED} - {name}
    if all(parameters.is_followed(read, other) for other in others):
        return heeded(trace, name)
    return read.step(*_larger(read, _ticking, _whole)) or heeded(trace, name)


def followed(trace: Trace) -> str:
    """Every change of a parameter takes effect: its callbacks are rewritten, or else the timer's, too."""
    read = started(trace)
    return read.step(*_larger(read, _following_by_one, _whole)) or (
        "in a post-set callback: cancel the timer, and make another one with the period 1.0 / rate"
    )


def resumed(trace: Trace) -> str:
    """The timer goes on, whatever `enabled` says: the timer's callback and those of the parameters are rewritten."""
    read = started(trace)
    return read.step(*_larger(read, _whole)) or (
        f"let one timer run on, and only skip publish() while {ENABLED} is false"
    )


def steady(trace: Trace) -> str:
    """One message for each call of the timer's callback, by one timer."""
    read = started(trace)
    return read.step(*_larger(read, _ticking_by_one, _whole)) or (
        f"publish one message in each callback of one timer, whose period is 1.0 / {RATE}"
    )


def cancelled(trace: Trace) -> str:
    """The old timer is cancelled before there is a new one."""
    read = started(trace)
    return read.step(parameters.cancelling(read)) or followed(trace)


def freed(trace: Trace, stuck: Sequence[Frame]) -> str:
    """Nothing waits in the callbacks of the timer or of the parameters, whichever it was."""
    read = started(trace)
    tick = read.tick
    here = {frame.line for frame in stuck}
    if tick is not None and any(tick.lineno <= line <= (tick.end_lineno or 0) for line in here):
        return read.step(*_larger(read, _ticking, _whole)) or resumed(trace)
    return followed(trace)


def refused(trace: Trace) -> str:
    """Bad rates are refused, before anything else is done."""
    read = started(trace)
    first = [*parameters.without_pre_set(read), *parameters.refusing(read, RATE)]
    return read.step(first, *_larger(read, _following)) or (
        "return SetParametersResult(successful=False, reason='...') from an on-set-parameters callback"
    )


def taken(trace: Trace, answer: SetAnswer) -> str:
    """A good value is accepted: the declaration leaves it free, and so do the callbacks."""
    read, reason = started(trace), answer.reason
    if "parameter list cannot be empty" in reason:
        return refused(trace)
    if (causes.RCLPYS_OWN.match(reason) and "Callback returned" not in reason) or "out of range" in reason:
        declaring = [each for n in answer.values for each in parameters.declared(read, n, DEFAULTS[n][1], plain=True)]
        return (
            read.step(declaring, *_larger(read, _following))
            or "declare it in __init__ with its default, and nothing more"
        )
    return separate(trace)


def separate(trace: Trace) -> str:
    """All values are checked before one takes effect."""
    read = started(trace)
    return read.step(*_larger(read, _following, _whole)) or (
        "only validate in the on-set callback; apply in a post-set callback (add_post_set_parameters_callback)"
    )


def checked_at_start(trace: Trace) -> str:
    """A bad rate that the node is started with is told by the parameter's name."""
    read = started(trace)
    return read.step(parameters.checked_at_start(read, RATE), program(read)) or (
        f"check it after declaring it, and log an error that names {RATE}"
    )


def anything(trace: Trace) -> str:
    """The program as a whole, whatever its fault is; empty where Python cannot read the file."""
    read = started(trace)
    return read.step(program(read)) or ""


def _larger(read: NodeFile, *parts: Callable[[NodeFile], list[Edit]]) -> list[list[Edit]]:
    """These parts, where it is sure what they do to the node, and the whole program."""
    return [*(part(read) for part in parts if whole.is_plain(read)), program(read)]


def _following(read: NodeFile) -> list[Edit]:
    return parameters.following(read, RATE, PREFIX, ENABLED)


def _ticking(read: NodeFile) -> list[Edit]:
    return publishing.ticking(read, publishing.text_with(read, PREFIX), enabled=ENABLED)


def _whole(read: NodeFile) -> list[Edit]:
    return [*_following(read), *publishing.only_timer(read), *_ticking(read)]


def _following_by_one(read: NodeFile) -> list[Edit]:
    return [*_following(read), *publishing.only_timer(read)]


def _ticking_by_one(read: NodeFile) -> list[Edit]:
    return [*_ticking(read), *publishing.only_timer(read)]
