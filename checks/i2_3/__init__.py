"""I2.3 Multi-Threaded Service: a slow service that must not block a fast timer, and a clean shutdown."""

from __future__ import annotations

from checks.i2_3 import judges, scenarios
from checks.i2_3.single_calls import call_singly
from tutor.judge.check import Check, Criterion

CHECK = Check(
    "i2.3",
    (
        Criterion(
            "blocks",
            judges.judge_blocks,
            (call_singly, scenarios.call_concurrently),
            early=((call_singly, judges.judge_blocks_so_far),),
        ),
        Criterion(
            "timer",
            judges.judge_timer,
            (scenarios.run_idle, call_singly),
            early=(
                (scenarios.run_idle, judges.judge_idle_timer),
                (call_singly, judges.judge_timer_so_far),
            ),
        ),
        Criterion(
            "concurrent",
            judges.judge_concurrent,
            (scenarios.call_concurrently, call_singly),
            early=((scenarios.call_concurrently, judges.judge_concurrent_so_far),),
        ),
        Criterion("shutdown", judges.judge_shutdown, (scenarios.run_idle,)),
        Criterion(
            "parallel",
            judges.judge_parallel,
            (call_singly, scenarios.call_concurrently),
            after=("blocks", "concurrent"),
            bonus=True,
        ),
        Criterion(
            "shutdown-busy",
            judges.judge_shutdown_busy,
            (scenarios.interrupt_during_call, call_singly),
            bonus=True,
        ),
    ),
    expected_s=6.3,
    expected_reason="two calls of 3 s, one after the other",
    mistakes="checks.i2_3.mistakes",
)
