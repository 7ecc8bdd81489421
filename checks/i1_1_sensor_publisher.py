"""I1.1 Sensor Publisher: random temperatures on /sensor/temperature, at a configurable rate, logged under a name."""

from __future__ import annotations

from tutor.exercise import (
    EndsCleanly,
    InRange,
    LogsParameter,
    OtherUnit,
    Program,
    Publishes,
    RateAtStart,
    ShownByEcho,
    Topic,
    Varies,
    check,
)

TEMPERATURE = Topic("/sensor/temperature", "std_msgs/msg/Float64", unit="°C", low=20.0, high=30.0)

publishes = Publishes("publishes", TEMPERATURE)

CHECK = check(
    "i1.1",
    Program("temperature_publisher.py"),
    publishes,
    InRange("range", TEMPERATURE, other_units=(OtherUnit("degrees Fahrenheit", 60, 90),), after=publishes),
    Varies("random", TEMPERATURE, after=publishes),
    ShownByEcho("echo", TEMPERATURE, after=publishes),
    RateAtStart("rate", TEMPERATURE, suggested="publish_rate", after=publishes),
    LogsParameter("sensor-name", TEMPERATURE, suggested="sensor_name", what="the sensor's name"),
    EndsCleanly("shutdown", bonus=True),
    expected_s=4.3,
    expected_reason="the rate at 0.7 Hz: 1.4 s to the first message, then two periods of 1.4 s",
)
