"""I2.1 Parameterized Publisher: three parameters that work at start-up and at run time, validated, with one timer."""

from __future__ import annotations

from checks.i2_1 import bad_values, changes, judges, runtime, scenarios, validation
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
        Criterion(
            "launch-params",
            judges.judge_launch,
            (scenarios.start_with_parameters,),
            early=((scenarios.start_with_parameters, judges.judge_launch_so_far),),
        ),
        Criterion(
            "runtime-params",
            runtime.judge_runtime,
            (changes.switch_at_runtime, changes.change_rate),
            early=((changes.switch_at_runtime, runtime.judge_changes),),
        ),
        Criterion(
            "validation",
            validation.judge_validation,
            (bad_values.ask_for_bad_rates, changes.switch_at_runtime),
            early=((bad_values.ask_for_bad_rates, validation.judge_validation_so_far),),
        ),
        Criterion("timer", runtime.judge_timer, (changes.change_rate,)),
        Criterion(
            "atomic",
            validation.judge_atomic,
            (bad_values.set_atomically, changes.switch_at_runtime, changes.change_rate),
            bonus=True,
        ),
        Criterion(
            "launch-validation",
            judges.judge_bad_launch,
            (scenarios.plain_start, scenarios.launch_with_bad_rates, scenarios.start_with_parameters),
            bonus=True,
        ),
        Criterion("shutdown", judges.judge_shutdown, (scenarios.plain_start,), bonus=True),
    ),
    expected_s=5.4,
    mistakes="checks.i2_1.mistakes",
    expected_reason="a change of the rate: 1.2 s to measure 10 Hz, 3.5 s to measure 0.75 Hz",
)
