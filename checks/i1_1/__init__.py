"""I1.1 Sensor Publisher: random temperatures on /sensor/temperature, at a configurable rate, logged under a name."""

from __future__ import annotations

from checks.i1_1 import judges, probes, scenarios, values
from tutor.judge.check import Check, Criterion

CHECK = Check(
    "i1.1",
    (
        Criterion("publishes", judges.judge_publishes, (scenarios.plain_start,)),
        Criterion(
            "range",
            judges.judge_range,
            (values.collect_values, values.collect_more_values),
            after=("publishes",),
            early=((values.collect_values, judges.judge_range_so_far),),
        ),
        Criterion("random", judges.judge_random, (values.collect_values,), after=("publishes",)),
        Criterion("echo", judges.judge_echo, (scenarios.plain_start,), after=("publishes",)),
        Criterion("rate", judges.judge_rate, (probes.probe_rates,), after=("publishes",)),
        Criterion("sensor-name", judges.judge_name, (probes.probe_names,)),
        Criterion("shutdown", judges.judge_shutdown, (scenarios.plain_start,), bonus=True),
    ),
    mistakes="checks.i1_1.mistakes",
    expected_s=4.3,
    expected_reason="the rate at 0.7 Hz: 1.4 s to the first message, then two periods of 1.4 s",
)
