"""Likely causes, by name: pure recognisers from what was seen to a `Cause`, shared by all checks."""

from tutor.judge.causes.blocking import (
    diagnose_blocked,
    is_in_blocking_call,
    use_reentrant_group,
    use_threads,
    waiting_for_lock,
)
from tutor.judge.causes.exceptions import diagnose_traceback, known
from tutor.judge.causes.output import diagnose_printed
from tutor.judge.causes.parameters import (
    RCLPYS_OWN,
    diagnose_refusal,
    diagnose_types,
    in_bursts,
    old_timer_kept,
    period_as_rate,
    rate_as_period,
)
from tutor.judge.causes.process import (
    QUICK_S,
    describe_no_answer,
    diagnose_no_answer,
    diagnose_process,
    diagnose_torn_thread,
    no_spin,
    output_tail,
    same_name,
)
from tutor.judge.causes.topics import (
    diagnose_deafness,
    diagnose_lifecycle,
    diagnose_silence,
    incompatible_qos,
    incompatible_service,
    wrong_topic,
)

__all__ = [
    "QUICK_S",
    "RCLPYS_OWN",
    "describe_no_answer",
    "diagnose_blocked",
    "diagnose_deafness",
    "diagnose_lifecycle",
    "diagnose_no_answer",
    "diagnose_printed",
    "diagnose_process",
    "diagnose_refusal",
    "diagnose_silence",
    "diagnose_torn_thread",
    "diagnose_traceback",
    "diagnose_types",
    "in_bursts",
    "incompatible_qos",
    "incompatible_service",
    "is_in_blocking_call",
    "known",
    "no_spin",
    "old_timer_kept",
    "output_tail",
    "period_as_rate",
    "rate_as_period",
    "same_name",
    "use_reentrant_group",
    "use_threads",
    "waiting_for_lock",
    "wrong_topic",
]
