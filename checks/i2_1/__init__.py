"""I2.1 Parameterized Publisher: three parameters that work at start-up and at run time, validated, with one timer."""

from __future__ import annotations

from checks.i2_1 import judges, scenarios
from tutor.judge.check import Check, Criterion

CHECK = Check(
    "i2.1",
    (
        Criterion(
            "defaults",
            judges.judge_defaults,
            (scenarios.plain_start,),
            early=((scenarios.plain_start, judges.judge_defaults_so_far),),
        ),
        Criterion("launch-params", judges.judge_launch, (scenarios.start_with_parameters,)),
        Criterion(
            "runtime-params",
            judges.judge_runtime,
            (scenarios.switch_at_runtime, scenarios.change_rate),
            early=((scenarios.switch_at_runtime, judges.judge_changes),),
        ),
        Criterion(
            "validation",
            judges.judge_validation,
            (scenarios.ask_for_bad_rates, scenarios.switch_at_runtime),
            early=((scenarios.ask_for_bad_rates, judges.judge_validation_so_far),),
        ),
        Criterion("timer", judges.judge_timer, (scenarios.change_rate,)),
        Criterion("atomic", judges.judge_atomic, (scenarios.set_atomically, scenarios.switch_at_runtime), bonus=True),
        Criterion(
            "launch-validation",
            judges.judge_bad_launch,
            (scenarios.plain_start, scenarios.launch_with_bad_rates),
            bonus=True,
        ),
        Criterion("shutdown", judges.judge_shutdown, (scenarios.plain_start,), bonus=True),
    ),
    # Switching `enabled` at 1 Hz: 2.6 s of silence, 1.1 s until it resumes, 2.2 s to measure the rate.
    expected_s=5.9,
)
