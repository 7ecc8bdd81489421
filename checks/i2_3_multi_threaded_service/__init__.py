"""I2.3 Multi-Threaded Service: a slow service that must not block a fast timer, and a clean shutdown."""

from __future__ import annotations

from checks.i2_3_multi_threaded_service import judges
from checks.i2_3_multi_threaded_service.call_scenarios import call_concurrently, interrupt_during_call
from checks.i2_3_multi_threaded_service.calls import PROGRAM
from checks.i2_3_multi_threaded_service.idle_run import run_idle
from checks.i2_3_multi_threaded_service.single_calls import call_singly
from tutor.exercise import Custom, EndsCleanly, check

blocks = Custom(
    "blocks",
    judges.judge_blocks,
    (call_singly, call_concurrently),
    early=((call_singly, judges.judge_blocks_so_far),),
)
concurrent = Custom(
    "concurrent",
    judges.judge_concurrent,
    (call_concurrently, call_singly),
    early=((call_concurrently, judges.judge_concurrent_so_far),),
)

CHECK = check(
    "i2.3",
    PROGRAM,
    blocks,
    Custom(
        "timer",
        judges.judge_timer,
        (run_idle, call_singly),
        early=((run_idle, judges.judge_idle_timer), (call_singly, judges.judge_timer_so_far)),
    ),
    concurrent,
    EndsCleanly("shutdown", start=run_idle),
    Custom("parallel", judges.judge_parallel, (call_singly, call_concurrently), after=(blocks, concurrent), bonus=True),
    Custom("shutdown-busy", judges.judge_shutdown_busy, (interrupt_during_call, call_singly), bonus=True),
    expected_s=6.3,
    expected_reason="two calls of 3 s, one after the other",
)
