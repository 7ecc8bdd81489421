"""Causes around parameters and what a node does with them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from tutor.judge.causes import names
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
    return Cause(
        "wrong parameter type",
        said,
        "the type of the default is the type of the parameter: declare a number, such as 1.0, not a text",
    )


def of_refusal(reason: str, values: Mapping[str, Any]) -> Cause:
    """Why a node does not take good `values`, from the `reason` that it gives."""
    if "invalid type" in reason:
        return Cause(
            names.CALLBACK_RETURNS_NONE,
            "the parameter callback does not return a SetParametersResult",
            "end every way through the callback with: return SetParametersResult(successful=True)",
        )
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
        "let the callback return SetParametersResult(successful=True) for it",
    )


def not_declared(name: str, default: Any) -> Cause:
    """The node has no such parameter."""
    return Cause(
        "parameter not declared",
        f"the node has no parameter {name}",
        f"self.declare_parameter('{name}', {default!r})",
    )


def in_bursts(name: str) -> Cause:
    """Several messages at once: of a loop in one callback, or of two timers that run together."""
    return Cause(
        "messages in bursts",
        "several messages are sent at once, then none for a while: that is no rate",
        f"publish one message in each callback of one timer, whose period is 1.0 / {name}",
    )


def rate_as_period(name: str) -> Cause:
    """The rate's number is taken for seconds."""
    return Cause(
        names.RATE_AS_PERIOD,
        f"{name} is given in Hz, but the timer waits that many seconds",
        f"the timer's period is 1.0 / {name}",
    )


def period_as_rate(name: str) -> Cause:
    """The period's number is taken for Hz."""
    return Cause(
        "period used as a rate",
        f"{name} is given as a period, but the node publishes that many times a second",
        f"give {name} to create_timer as it is, or call it a rate",
    )


def timer_not_replaced() -> Cause:
    """The parameter has a new value, the timer its old period."""
    return Cause(
        names.TIMER_NOT_REPLACED,
        "the parameter changes, but the timer keeps its old period",
        "in the parameter callback: self.timer.cancel(), then self.timer = self.create_timer(1.0 / rate, ...)",
    )


def old_timer_kept(hz: float, asked_hz: float) -> Cause:
    """There is a new timer, and the old one as well."""
    return Cause(
        names.OLD_TIMER_KEPT,
        f"{hz:.1f} Hz is more than {asked_hz:g} Hz: an older timer publishes too, since nothing cancelled it",
        "cancel the old timer before you make the new one: self.destroy_timer(self.timer)",
    )
