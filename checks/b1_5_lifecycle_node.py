"""B1.5 A Lifecycle Node: a sensor that is configured, activated, deactivated and cleaned up by others."""

from __future__ import annotations

from tutor.exercise import (
    Activates,
    BeginsUnconfigured,
    CleansUp,
    Configures,
    Deactivates,
    EndsCleanly,
    FailsToConfigure,
    Lifecycle,
    Parameter,
    Program,
    SetsRate,
    ShutsDown,
    Topic,
    WhileActive,
    check,
)

SENSOR_NODE = Program("distance_sensor.py")
DISTANCE = Topic("/distance", "std_msgs/msg/Float64")
SENSOR = Lifecycle("/distance_sensor", DISTANCE, Parameter("rate", 5.0, SetsRate(DISTANCE)))

begins = BeginsUnconfigured("begins", SENSOR)
configures = Configures("configure", SENSOR, after=begins)
activates = Activates("activate", SENSOR, after=configures)
deactivates = Deactivates("deactivate", SENSOR, after=activates)

CHECK = check(
    "b1.5",
    SENSOR_NODE,
    begins,
    configures,
    activates,
    deactivates,
    # Below the default: a timer that is left from before shows beside it.
    CleansUp("cleanup", SENSOR, again_hz=2.0, after=deactivates),
    # A good rate that is no whole number: nothing is measured with it.
    FailsToConfigure("bad-rate", SENSOR, bad=(-1.0, 0.0), good=0.5, after=configures),
    ShutsDown("finalize", SENSOR, after=configures),
    EndsCleanly("shutdown", bonus=True),
    EndsCleanly("shutdown-active", WhileActive(SENSOR_NODE, SENSOR), activates, after=activates, bonus=True),
    expected_s=6.4,
    expected_reason="a whole life: the rate three times (1.1 s, 1.1 s and 1.8 s), and silence three times",
)
