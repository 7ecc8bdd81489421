"""B1.3 A Message of Your Own: a message and a service type, built in a package, and a node that uses both."""

from __future__ import annotations

import random

from tutor.exercise import (
    Answers,
    BuildsInterfaces,
    EndsCleanly,
    FieldEquals,
    Program,
    Publishes,
    Question,
    Serves,
    Service,
    Stamped,
    Topic,
    check,
)

READING, TYPE = "/tank/reading", "my_interfaces/msg/Reading"

VALUE = Topic(READING, TYPE, field="value")
UNIT = Topic(READING, TYPE, field="unit")
STAMP = Topic(READING, TYPE, field="header.stamp")
IN_RANGE = Service(
    "/tank/in_range",
    "my_interfaces/srv/InRange",
    ("value", "low", "high"),
    "inside",
    lambda value, low, high: low <= value <= high,
)


FIXED = [
    (0, -5, 5),
    (0, 3, 9),  # the same value in another range, with another answer
    (7, 3, 9),
    (7, 10, 20),
    (-3, 0, 10),
    (3, 0, 10),
    (-3, -10, 0),
    (3, -10, 0),
    (0, 0, 0),
    (4, 4, 4),  # a range of one number
    (5, 4, 4),
    (2**53, 2**53 + 1, 2**53 + 10),  # equal as floats
    (2**53 + 1, 2**53 - 10, 2**53),
]
"""Requests that answers tend to be wrong for: zeros, one value in two ranges, a single number, large numbers."""


def questions() -> list[Question]:
    """Return values outside, inside and at both limits of drawn ranges, some of which are negative, and `FIXED`."""
    asked = list(FIXED)
    for low in (random.randint(-90, -50), random.randint(-20, -10), random.randint(20, 60)):
        high = low + random.randint(4, 40)
        asked += [(value, low, high) for value in (low - 1, low, low + 1, high - 1, high, high + 1)]
    random.shuffle(asked)
    return [(IN_RANGE, values) for values in asked]


interfaces = BuildsInterfaces(
    "interfaces",
    "my_interfaces",
    {
        "msg/Reading": ("std_msgs/Header header", "string sensor", "float64 value", "string unit"),
        "srv/InRange": ("int64 value", "int64 low", "int64 high", "---", "bool inside"),
    },
)
publishes = Publishes("publishes", VALUE, at_least_hz=2.0, after=interfaces)
serves = Serves("in-range", (IN_RANGE,), call_with=(5, 0, 10), after=interfaces)

CHECK = check(
    "b1.3",
    Program("tank_sensor.py"),
    interfaces,
    publishes,
    Stamped("stamped", STAMP, within_s=2.0, after=publishes),
    FieldEquals("unit", UNIT, "percent", every=True, within_s=2.0, after=publishes),
    FieldEquals(
        "value",
        VALUE,
        lambda v: 0.0 <= v <= 100.0,
        what="a level from 0 to 100",
        every=True,
        within_s=2.0,
        after=publishes,
    ),
    serves,
    Answers("answers", (IN_RANGE,), questions, after=interfaces),
    EndsCleanly("shutdown", bonus=True),
    expected_s=3.0,
    expected_reason="2 s in which every message is looked at",
)
