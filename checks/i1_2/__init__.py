"""I1.2 Message Counter and Statistics: a subscriber that summarises its messages and notices gaps."""

from __future__ import annotations

from pathlib import Path

from checks.i1_2 import fast_stretch, judges, scenarios
from checks.i1_2.deeper_causes import with_deeper_cause
from checks.i1_2.gaps import judge_gaps
from checks.i1_2.restart import judge_restart
from tutor.judge.check import Check, Criterion
from tutor.judge.exceptions import load

CHECK = Check(
    "i1.2",
    (
        Criterion(
            "count",
            with_deeper_cause(judges.judge_count),
            (scenarios.steady, scenarios.jump, scenarios.fast),
            early=((scenarios.fast, with_deeper_cause(fast_stretch.judge_fast_count)),),
        ),
        Criterion(
            "rate",
            with_deeper_cause(judges.judge_rate),
            (scenarios.steady, scenarios.jump, scenarios.restart, scenarios.fast),
        ),
        Criterion(
            "summary",
            with_deeper_cause(judges.judge_summary),
            (scenarios.steady, scenarios.jump, scenarios.fast),
            early=((scenarios.fast, with_deeper_cause(fast_stretch.judge_fast_summary)),),
        ),
        Criterion(
            "restart",
            with_deeper_cause(judge_restart),
            (scenarios.restart, scenarios.steady, scenarios.jump, scenarios.fast),
        ),
        Criterion(
            "gaps",
            with_deeper_cause(judge_gaps),
            (
                scenarios.jump,
                scenarios.jump_twice,
                scenarios.jump_after_zero,
                scenarios.restart,
                scenarios.steady,
                scenarios.fast,
            ),
        ),
        Criterion("shutdown", judges.judge_shutdown, (scenarios.fast,), bonus=True),
    ),
    expected_s=5.0,
    expected_reason="25 messages at 8 or 9.4 a second, and 2 s without any while the publisher is replaced",
    exceptions=load(Path(__file__).with_name("exceptions.toml")),
)
