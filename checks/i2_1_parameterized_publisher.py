"""I2.1 Parameterized Publisher: three parameters that work at start-up and at run time, validated, with one timer."""

from __future__ import annotations

from tutor.exercise import (
    Defaults,
    EndsCleanly,
    NamesBadValue,
    Parameter,
    Program,
    RateAtRunTime,
    Rejects,
    RejectsAtomically,
    SetAtRunTime,
    SetAtStart,
    SetsRate,
    ShownIn,
    SwitchesOff,
    Topic,
    check,
)

CHATTER = Topic("/chatter", "std_msgs/msg/String")

PREFIX = Parameter("message_prefix", "Hello", ShownIn(CHATTER))
RATE = Parameter("publish_rate", 1.0, SetsRate(CHATTER))
ENABLED = Parameter("enabled", True, SwitchesOff(CHATTER))

BAD_RATES = (0.0, -1.0)

CHECK = check(
    "i2.1",
    Program("parameterized_publisher.py"),
    Defaults("defaults", (PREFIX, RATE, ENABLED)),
    # The second rate exposes rounding. The switched-off node is started at 5 Hz, so that a message shows soon.
    SetAtStart("launch-params", ({PREFIX: "Ahoy7", RATE: 5.0}, {RATE: 1.5}, {ENABLED: False, RATE: 5.0})),
    SetAtRunTime("runtime-params", PREFIX, ("Servus7", "Gruezi9"), switch=ENABLED),
    Rejects("validation", RATE, BAD_RATES, while_at=3.0),
    RateAtRunTime("timer", RATE, (10.0, 0.75)),
    RejectsAtomically("atomic", PREFIX, ("Partial1", "Partial2", "Whole1"), RATE, bad=-1.0, good=3.0, bonus=True),
    NamesBadValue("launch-validation", RATE, BAD_RATES, bonus=True),
    EndsCleanly("shutdown", bonus=True),
    expected_s=5.4,
    expected_reason="a change of the rate: 1.2 s to measure 10 Hz, 3.5 s to measure 0.75 Hz",
)
