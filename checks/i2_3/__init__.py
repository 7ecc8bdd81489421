"""I2.3 Multi-Threaded Service: a slow service beside a fast timer that it must not hold up, and a clean end of both."""

from __future__ import annotations

from checks.i2_3 import judges, scenarios
from tutor.judge.check import Check, Criterion

CHECK = Check(
    "i2.3",
    (
        Criterion("blocks", judges.judge_blocks, (scenarios.lone, scenarios.trio)),
        Criterion("timer", judges.judge_timer, (scenarios.quiet, scenarios.lone)),
        Criterion("concurrent", judges.judge_concurrent, (scenarios.trio, scenarios.lone)),
        Criterion("shutdown", judges.judge_shutdown, (scenarios.quiet,)),
        Criterion(
            "parallel",
            judges.judge_parallel,
            (scenarios.lone, scenarios.trio),
            after=("blocks", "concurrent"),
            bonus=True,
        ),
        Criterion("shutdown-busy", judges.judge_shutdown_busy, (scenarios.interrupted, scenarios.lone), bonus=True),
    ),
    asks_s=8.0,  # lone: two calls of 3 s, each until the message of the next tenth tick, 4 s and 8 s after the start
)
