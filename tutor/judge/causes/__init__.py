"""Likely causes of failures, shared by all checks: pure functions from observed facts to a `Cause`."""

from tutor.judge.causes.blocking import (
    diagnose_blocked,
    diagnose_lock_wait,
    is_in_blocking_call,
    use_reentrant_group,
    use_threads,
)
from tutor.judge.causes.exceptions import diagnose_known_exception, diagnose_traceback
from tutor.judge.causes.lifecycle import diagnose_lifecycle
from tutor.judge.causes.output import diagnose_printed
from tutor.judge.causes.parameters import (
    RCLPY_REASON,
    diagnose_old_timer,
    diagnose_parameter_type,
    diagnose_period_as_rate,
    diagnose_rate_as_period,
    diagnose_refusal,
)
from tutor.judge.causes.period_slips import diagnose_bursts
from tutor.judge.causes.process import (
    QUICK_S,
    describe_no_answer,
    diagnose_no_answer,
    diagnose_no_spin,
    diagnose_process,
    diagnose_same_name,
    diagnose_torn_thread,
    output_tail,
)
from tutor.judge.causes.spinning import diagnose_not_spinning
from tutor.judge.causes.topics import (
    diagnose_incompatible_qos,
    diagnose_incompatible_service,
    diagnose_no_messages,
    diagnose_nothing_received,
    diagnose_unused_publisher,
    diagnose_wrong_topic,
)

__all__ = [
    "QUICK_S",
    "RCLPY_REASON",
    "describe_no_answer",
    "diagnose_blocked",
    "diagnose_bursts",
    "diagnose_incompatible_qos",
    "diagnose_incompatible_service",
    "diagnose_known_exception",
    "diagnose_lifecycle",
    "diagnose_lock_wait",
    "diagnose_no_answer",
    "diagnose_no_messages",
    "diagnose_no_spin",
    "diagnose_not_spinning",
    "diagnose_nothing_received",
    "diagnose_old_timer",
    "diagnose_parameter_type",
    "diagnose_period_as_rate",
    "diagnose_printed",
    "diagnose_process",
    "diagnose_rate_as_period",
    "diagnose_refusal",
    "diagnose_same_name",
    "diagnose_torn_thread",
    "diagnose_traceback",
    "diagnose_unused_publisher",
    "diagnose_wrong_topic",
    "is_in_blocking_call",
    "output_tail",
    "use_reentrant_group",
    "use_threads",
]
