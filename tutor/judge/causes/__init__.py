"""Likely causes, by name: pure recognisers from what was seen to a `Cause`, shared by all checks."""

from tutor.judge.causes.blocking import in_call, in_groups, in_threads, of_blocked, waiting_for_lock
from tutor.judge.causes.exceptions import known, of_traceback
from tutor.judge.causes.output import of_printed
from tutor.judge.causes.parameters import (
    RCLPYS_OWN,
    in_bursts,
    of_refusal,
    of_types,
    old_timer_kept,
    period_as_rate,
    rate_as_period,
)
from tutor.judge.causes.process import (
    QUICK_S,
    last_words,
    no_spin,
    of_no_answer,
    of_process,
    of_torn_thread,
    same_name,
    unanswered,
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
    "in_groups",
    "in_threads",
    "incompatible_qos",
    "incompatible_service",
    "known",
    "last_words",
    "no_spin",
    "of_blocked",
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
    "unanswered",
    "waiting_for_lock",
    "wrong_topic",
]
