"""I1.2 Message Counter and Statistics: a subscriber that summarises its messages and notices gaps."""

from __future__ import annotations

from checks.i1_2_message_statistics import plans
from checks.i1_2_message_statistics.count import judge_count, judge_fast_count
from checks.i1_2_message_statistics.feeding import QUIET_S, Feed
from checks.i1_2_message_statistics.gaps import judge_gaps
from checks.i1_2_message_statistics.rate import judge_rate
from checks.i1_2_message_statistics.restart import judge_restart
from checks.i1_2_message_statistics.summary import judge_fast_summary, judge_summary
from checks.i1_2_message_statistics.trial import PROGRAM
from tutor.exercise import Custom, EndsCleanly, check

STEADY = Feed(plans.steadily, settled_s=QUIET_S, explains_silence=True)
JUMP = Feed(plans.jumping)
JUMP_TWICE = Feed(plans.jumping_twice)
JUMP_AFTER_ZERO = Feed(plans.jumping_after_zero)
RESTART = Feed(plans.starting_over)
FAST = Feed(plans.fast, ctrl_c=True)

summary = Custom("summary", judge_summary, (STEADY, JUMP, FAST), early=((FAST, judge_fast_summary),))

CHECK = check(
    "i1.2",
    PROGRAM,
    Custom("count", judge_count, (STEADY, JUMP, FAST), early=((FAST, judge_fast_count),)),
    Custom("rate", judge_rate, (STEADY, JUMP, RESTART, FAST)),
    summary,
    Custom("restart", judge_restart, (STEADY, JUMP, RESTART, FAST)),
    Custom("gaps", judge_gaps, (STEADY, JUMP, JUMP_TWICE, JUMP_AFTER_ZERO, RESTART, FAST)),
    EndsCleanly("shutdown", FAST, shown_by=summary, bonus=True),
    expected_s=5.0,
    expected_reason="25 messages at 8 or 9.4 a second, and 2 s without any while the publisher is replaced",
    mistakes="checks.i1_2_message_statistics.mistakes",
)
