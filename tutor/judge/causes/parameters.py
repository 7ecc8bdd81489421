"""Causes around parameters and what a node does with them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from tutor.judge.causes import names, parameter_use, timers
from tutor.judge.reading import UNREAD, Source
from tutor.judge.verdict import Cause

RCLPYS_OWN = re.compile(
    r"Callback returned an invalid type"
    r"|Wrong parameter type, expected '.*' got '"
    r"|Trying to set a read-only parameter: "
    r"|Static parameter cannot be undeclared"
    r"|parameter list cannot be empty, this might be due to pre_set_parameters_callback"
    r"|Invalid access to undeclared parameter\(s\): "
)
"""How reasons begin that rclpy gives by itself, whole sentences: a learner may say "it cannot be set to 0", too.

They are not the learner's. (That a value is outside a declared range is.)
"""

_TYPES = re.compile(r"(?:of type|got) '(?:Type\.)?(?P<given>\w+)'|expect(?:ing type|ed) '(?:Type\.)?(?P<wanted>\w+)'")

_DEFAULTS = {
    "BOOL": "True or False, without quotation marks, not a text or a number",
    "DOUBLE": "a decimal number, such as 1.0, without quotation marks",
    "INTEGER": "a whole number, such as 1, without quotation marks",
    "STRING": "a text, such as 'Hello'",
}
_RANGE = re.compile(r"out of range Min: (?P<low>[-\d.e+]+), Max: (?P<high>[-\d.e+]+)|not close enough to a valid step")


def of_types(said: str) -> Cause:
    """A value of one type was given to a parameter of another; `said` is rclpy's message, which names both."""
    found = list(_TYPES.finditer(said))
    given = next((m["given"] for m in found if m["given"]), "")
    wanted = next((m["wanted"] for m in found if m["wanted"]), "")
    if {given, wanted} == {"INTEGER", "DOUBLE"}:
        hint = (
            "the type of the default is the type of the parameter: declare 1.0, not 1, where a rate may have decimals"
            if wanted == "INTEGER"
            else "the parameter is a double: give it a decimal number, such as 5.0, not 5"
        )
        return Cause(names.INTEGER_PARAMETER, said, hint)
    default = _DEFAULTS.get(given, "a value of the type that is given")
    return Cause(
        "wrong parameter type", said, f"the type of the default is the type of the parameter: declare {default}"
    )


def of_refusal(reason: str, values: Mapping[str, Any], source: Source = UNREAD) -> Cause:
    """Why a node does not take good `values`, from the `reason` that it gives."""
    if "invalid type" in reason:
        called = parameter_use.callback(source)
        which = f"{called.name} (line {called.line})" if called else "the callback"
        return Cause(
            names.CALLBACK_RETURNS_NONE,
            f"the parameter callback{f', {which},' if called else ''} does not return a SetParametersResult",
            f"end every way through {which} with: return SetParametersResult(successful=True)",
        )
    if found := _RANGE.search(reason):
        return _of_range(found, reason, source)
    if "parameter list cannot be empty" in reason:
        return Cause(
            "value dropped",
            "a pre-set callback takes the value out of the list, and rclpy can only say that nothing is left",
            "leave it in the list: an on-set callback is the one that says yes, or no with a reason",
        )
    if _TYPES.search(reason):
        return of_types(reason)
    if "declared" in reason:
        return Cause("parameter not declared", reason, f"declare it in __init__: {', '.join(values)}")
    if "read-only" in reason:
        return Cause("rejected", reason, "declare it without read_only=True, so that it can be set later")
    return Cause(
        "rejected",
        f'the node rejects a good value: "{reason}"' if reason else "the node rejects a good value, without a reason",
        _accepting(source) or "let the callback return SetParametersResult(successful=True) for it",
    )


def _of_range(found: re.Match[str], reason: str, source: Source) -> Cause:
    """A declared range leaves out good values."""
    made = next(iter(source.calls("FloatingPointRange", "IntegerRange")), None)
    where = f"line {made.line}: " if made else "in the parameter's descriptor: "
    right = "FloatingPointRange(from_value=0.01, to_value=1000.0, step=0.0)"
    what = "values between its steps" if found["low"] is None else f"all but {found['low']} to {found['high']}"
    return Cause("range too narrow", f'the declared range refuses {what}: "{reason}"', f"{where}{right}")


def _accepting(source: Source) -> str | None:
    """The step where a result says no only because nobody let it say yes."""
    for made in source.calls("SetParametersResult"):
        if not made.given and "successful" not in made.named:
            return f"line {made.line}: SetParametersResult(successful=True): without it, a result means no"
    return None


def not_declared(name: str, default: Any, source: Source = UNREAD) -> Cause:
    """The node has no such parameter."""
    return Cause(
        "parameter not declared",
        f"the node has no parameter {name}",
        parameter_use.declared_right(source, name, default),
    )


def in_bursts(name: str) -> Cause:
    """Several messages at once: of a loop in one callback, or of two timers that run together."""
    return Cause(
        "messages in bursts",
        "several messages are sent at once, then none for a while: that is no rate",
        f"publish one message in each callback of one timer, whose period is 1.0 / {name}",
    )


def rate_as_period(name: str, source: Source = UNREAD) -> Cause:
    """The rate's number is taken for seconds."""
    return Cause(
        names.RATE_AS_PERIOD,
        f"{name} is given in Hz, but the timer waits that many seconds",
        timers.as_period(source, name) or f"the timer's period is 1.0 / {name}",
    )


def period_as_rate(name: str, source: Source = UNREAD) -> Cause:
    """The period's number is taken for Hz."""
    return Cause(
        "period used as a rate",
        f"{name} is given as a period, but the node publishes that many times a second",
        timers.as_rate(source) or f"give {name} to create_timer as it is, or call it a rate",
    )


def timer_not_replaced(name: str = "publish_rate", source: Source = UNREAD) -> Cause:
    """The parameter has a new value, the timer its old period."""
    uses = (parameter_use.overridden, parameter_use.old_value_read)
    if (cause := next((each for use in uses if (each := use(source, name))), None)) is not None:
        return cause
    if (cause := parameter_use.not_called(source)) is not None:
        return cause
    changed = parameter_use.callback(source)
    if changed is not None and (made := timers.remade(source, changed)) is not None:
        return timers.stays(source, name, made)
    if source.calls("create_timer"):
        return Cause(
            names.TIMER_NOT_REPLACED,
            "the parameter changes, but the timer keeps its old period: nothing makes a new one",
            timers.post_set(source, name),
        )
    return Cause(
        names.TIMER_NOT_REPLACED,
        "the parameter changes, but the timer keeps its old period",
        "in the parameter callback: self.timer.cancel(), then self.timer = self.create_timer(1.0 / rate, ...)",
    )


def old_timer_kept(hz: float, asked_hz: float, source: Source = UNREAD) -> Cause:
    """There is a new timer, and the old one as well."""
    return Cause(
        names.OLD_TIMER_KEPT,
        f"{hz:.1f} Hz is more than {asked_hz:g} Hz: an older timer publishes too, since nothing cancelled it",
        timers.beside(source) or "cancel the old timer before you make the new one: self.destroy_timer(self.timer)",
    )
