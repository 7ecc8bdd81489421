"""I1.2 Message Counter and Statistics: a subscriber that summarises its messages and notices gaps."""

from __future__ import annotations

from checks.i1_2 import fast_stretch, judges, scenarios
from checks.i1_2.gaps import judge_gaps
from checks.i1_2.restart import judge_restart
from checks.i1_2.side_facts import with_side_facts
from tutor.judge.check import Check, Criterion

CHECK = Check(
    "i1.2",
    (
        Criterion(
            "count",
            with_side_facts(judges.judge_count),
            (scenarios.steady, scenarios.jump, scenarios.fast),
            early=((scenarios.fast, with_side_facts(fast_stretch.judge_fast_count)),),
        ),
        Criterion(
            "rate",
            with_side_facts(judges.judge_rate),
            (scenarios.steady, scenarios.jump, scenarios.restart, scenarios.fast),
        ),
        Criterion(
            "summary",
            with_side_facts(judges.judge_summary),
            (scenarios.steady, scenarios.jump, scenarios.fast),
            early=((scenarios.fast, with_side_facts(fast_stretch.judge_fast_summary)),),
        ),
        Criterion(
            "restart",
            with_side_facts(judge_restart),
            (scenarios.restart, scenarios.steady, scenarios.jump, scenarios.fast),
        ),
        Criterion(
            "gaps",
            with_side_facts(judge_gaps),
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
    mistakes="checks.i1_2.mistakes",
)
