"""Causes around parameters and how a node uses them."""

from __future__ import annotations

import re
from dataclasses import replace

from tutor.judge.causes import names
from tutor.judge.verdict import Cause

RCLPY_REASON = re.compile(
    r"Callback returned an invalid type"
    r"|Wrong parameter type, expected '.*' got '"
    r"|Trying to set a read-only parameter: "
    r"|Static parameter cannot be undeclared"
    r"|parameter list cannot be empty, this might be due to pre_set_parameters_callback"
    r"|Invalid access to undeclared parameter\(s\): "
)
"""Reasons that rclpy itself gives for rejecting a value, in contrast to a learner's own.

The patterns are nearly whole sentences, since a learner's reason may well read "it cannot be set to 0". A value outside
a declared range is not among them: the learner declared that range.
"""

_TYPES = re.compile(r"(?:of type|got) '(?:Type\.)?(?P<given>\w+)'|expect(?:ing type|ed) '(?:Type\.)?(?P<wanted>\w+)'")

_DEFAULTS = {
    "BOOL": "True or False, without quotation marks, not a text or a number",
    "DOUBLE": "a decimal number, such as 1.0, without quotation marks",
    "INTEGER": "a whole number, such as 1, without quotation marks",
    "STRING": "a text, such as 'Hello'",
}
_RANGE = re.compile(r"out of range Min: (?P<low>[-\d.e+]+), Max: (?P<high>[-\d.e+]+)|not close enough to a valid step")


def diagnose_parameter_type(message: str) -> Cause:
    """A value of one type was given to a parameter of another; `message` is rclpy's, which names both types."""
    found = list(_TYPES.finditer(message))
    given = next((m["given"] for m in found if m["given"]), "")
    wanted = next((m["wanted"] for m in found if m["wanted"]), "")
    if {given, wanted} == {"INTEGER", "DOUBLE"}:
        hint = (
            "the type of the default is the type of the parameter: declare 1.0, not 1, where a rate may have decimals"
            if wanted == "INTEGER"
            else "the parameter is a double: give it a decimal number, such as 5.0, not 5"
        )
        return Cause(names.INTEGER_PARAMETER, message, hint)
    default = _DEFAULTS.get(given, "a value of the type that is given")
    return Cause(
        "wrong parameter type", message, f"the type of the default is the type of the parameter: declare {default}"
    )


def diagnose_refusal(reason: str, step: str) -> Cause:
    """Why a node rejects a good value, judging by its `reason`; `step` makes it accept the value."""
    if "invalid type" in reason:
        text = "the parameter callback does not return a SetParametersResult"
        return Cause(names.CALLBACK_RETURNS_NONE, text, step)
    if found := _RANGE.search(reason):
        what = "values between its steps" if found["low"] is None else f"all but {found['low']} to {found['high']}"
        return Cause("range too narrow", f'the declared range refuses {what}: "{reason}"', step)
    if "parameter list cannot be empty" in reason:
        text = "a pre-set callback takes the value out of the list, and rclpy can only say that nothing is left"
        return Cause("value dropped", text, step)
    if _TYPES.search(reason):
        return replace(diagnose_parameter_type(reason), hint=step)
    if "declared" in reason:
        return Cause("parameter not declared", reason, step)
    text = f'the node rejects a good value: "{reason}"' if reason else "the node rejects a good value, without a reason"
    return Cause("rejected", reason if "read-only" in reason else text, step)


def diagnose_rate_as_period(name: str, step: str) -> Cause:
    """A rate in Hz is used as a period in seconds."""
    return Cause(names.RATE_AS_PERIOD, f"{name} is given in Hz, but the timer waits that many seconds", step)


def diagnose_period_as_rate(name: str, step: str) -> Cause:
    """A period in seconds is used as a rate in Hz."""
    text = f"{name} is given as a period, but the node publishes that many times a second"
    return Cause("period used as a rate", text, step)


def diagnose_old_timer(hz: float, asked_hz: float, step: str) -> Cause:
    """A new timer was created, but the old one still runs."""
    return Cause(
        names.OLD_TIMER_KEPT,
        f"{hz:.1f} Hz is more than {asked_hz:g} Hz: an older timer publishes too, since nothing cancelled it",
        step,
    )
