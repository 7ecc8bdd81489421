"""Likely causes, by name: pure recognisers from what was seen to a `Cause`, shared by all checks."""

from tutor.judge.causes.exceptions import of_traceback
from tutor.judge.causes.output import of_printed
from tutor.judge.causes.parameters import (
    RCLPYS_OWN,
    in_bursts,
    not_declared,
    of_refusal,
    of_types,
    old_timer_kept,
    period_as_rate,
    rate_as_period,
    timer_not_replaced,
)
from tutor.judge.causes.process import (
    QUICK_S,
    in_call,
    last_words,
    no_spin,
    of_no_answer,
    of_process,
    of_torn_thread,
    same_name,
)
from tutor.judge.causes.topics import (
    incompatible_qos,
    incompatible_service,
    of_deafness,
    of_lifecycle,
    of_qos,
    of_silence,
    wrong_topic,
)

__all__ = [
    "QUICK_S",
    "RCLPYS_OWN",
    "in_bursts",
    "in_call",
    "incompatible_qos",
    "incompatible_service",
    "last_words",
    "no_spin",
    "not_declared",
    "of_deafness",
    "of_lifecycle",
    "of_no_answer",
    "of_printed",
    "of_process",
    "of_qos",
    "of_refusal",
    "of_silence",
    "of_torn_thread",
    "of_traceback",
    "of_types",
    "old_timer_kept",
    "period_as_rate",
    "rate_as_period",
    "same_name",
    "timer_not_replaced",
    "wrong_topic",
]
