"""I1.3 Calculator Service: four services that calculate and report a division by zero, and a client that calls all."""

from __future__ import annotations

from checks.i1_3 import client, judges, scenarios
from checks.i1_3.division import judge_division
from tutor.judge.check import Check, Criterion

CHECK = Check(
    "i1.3",
    (
        Criterion("services", judges.judge_services, (scenarios.call_each_service,)),
        Criterion(
            "operations", judges.judge_operations, (scenarios.call_with_random_operands, scenarios.call_each_service)
        ),
        Criterion("divide-by-zero", judge_division, (scenarios.divide_by_zero,), after=("services",)),
        Criterion("client", client.judge_client, (scenarios.run_client,)),
        Criterion("shutdown", judges.judge_shutdown, (scenarios.call_each_service,), bonus=True),
    ),
    expected_s=1.1,
    mistakes="checks.i1_3.mistakes",
    expected_reason="a division by zero: 0.6 s until the log is quiet, 0.5 s in which a node may exit",
)
