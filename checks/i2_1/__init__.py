"""I2.1 Parameterized Publisher: three parameters that work at start-up and at run time, validated, with one timer."""

from __future__ import annotations

from checks.i2_1 import judges, scenarios
from tutor.judge.check import Check, Criterion

CHECK = Check(
    "i2.1",
    (
        Criterion("defaults", judges.judge_defaults, (scenarios.survey,)),
        Criterion("launch-params", judges.judge_launch, (scenarios.launched,)),
        Criterion("runtime-params", judges.judge_runtime, (scenarios.switched, scenarios.retimed)),
        Criterion("validation", judges.judge_validation, (scenarios.validated, scenarios.switched)),
        Criterion("timer", judges.judge_timer, (scenarios.retimed,)),
        Criterion("atomic", judges.judge_atomic, (scenarios.atomic, scenarios.switched), bonus=True),
        Criterion("launch-validation", judges.judge_bad_launch, (scenarios.survey, scenarios.bad_launches), bonus=True),
        Criterion("shutdown", judges.judge_shutdown, (scenarios.survey,), bonus=True),
    ),
    # switched, at 1 Hz: 1 s to the first message, 1 s to the next, 2.6 s of silence, 1.1 s to resume, 2.2 s to go on
    asks_s=7.9,
)
