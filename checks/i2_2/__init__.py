"""I2.2 Launch File Creation: one command starts two nodes, with launch arguments for topic and namespace."""

from __future__ import annotations

from checks.i2_2 import judges, scenarios
from tutor.judge.check import Check, Criterion

CHECK = Check(
    "i2.2",
    (
        Criterion("starts", judges.judge_starts, (scenarios.plain,)),
        Criterion("topic", judges.judge_topic, (scenarios.plain, scenarios.other_topic), after=("starts",)),
        Criterion(
            "namespace",
            judges.judge_namespace,
            (
                scenarios.plain,
                scenarios.other_topic,
                scenarios.other_namespace,
                scenarios.both,
                scenarios.another_namespace,
            ),
            after=("starts",),
        ),
        Criterion("communicates", judges.judge_communicates, (scenarios.plain,), after=("starts",)),
        Criterion("shutdown", judges.judge_shutdown, (scenarios.plain,), after=("starts",), bonus=True),
    ),
    expected_s=0.5,
    expected_reason="the first message of our solution",
)
