"""I1.3 Calculator Service: four services that calculate, say so when they cannot, and a client that uses them all."""

from __future__ import annotations

from checks.i1_3 import client, judges, scenarios
from tutor.judge.check import Check, Criterion

CHECK = Check(
    "i1.3",
    (
        Criterion("services", judges.judge_services, (scenarios.survey,)),
        Criterion("operations", judges.judge_operations, (scenarios.calculation,)),
        Criterion("divide-by-zero", judges.judge_division, (scenarios.division,), after=("services",)),
        Criterion("client", client.judge_client, (scenarios.demonstration,)),
        Criterion("shutdown", judges.judge_shutdown, (scenarios.survey,), bonus=True),
    ),
    asks_s=1.1,  # division: 0.6 s until the log has been quiet, 0.5 s for a node that gives up afterwards
)
