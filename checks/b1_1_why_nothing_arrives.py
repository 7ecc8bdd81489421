"""B1.1 Why Nothing Arrives: a late subscriber gets a kept map, each reading of a lossy sensor, and a whole burst."""

from __future__ import annotations

import random

from tutor.exercise import EndsCleanly, GivenPublisher, Program, QoS, ShowsEach, Topic, check

STRING = "std_msgs/msg/String"

READINGS = 12
PARCELS = 200


def map_name() -> list[str]:
    """Return the name of a map."""
    return [f"hall-{random.randint(1000, 9999)}"]


def readings() -> list[int]:
    """Return distances in mm."""
    return random.sample(range(10_000, 60_000), READINGS)


def labels() -> list[str]:
    """Return the labels of the parcels of one lorry."""
    lorry = random.randint(100, 999)
    return [f"lorry-{lorry}-{number:03}" for number in range(1, PARCELS + 1)]


MAP = GivenPublisher(Topic("/map", STRING), map_name, sends="before", offers=QoS(durability="transient_local"))
RANGE = GivenPublisher(
    Topic("/range", "std_msgs/msg/Int32"), readings, offers=QoS(reliability="best_effort"), every_s=0.2
)
LORRY = GivenPublisher(Topic("/parcels", STRING), labels, sends="at once")

CHECK = check(
    "b1.1",
    Program("warehouse_monitor.py"),
    ShowsEach("map", MAP),
    ShowsEach("range", RANGE),
    ShowsEach("parcels", LORRY),
    EndsCleanly("shutdown", bonus=True),
    expected_s=6.0,
    expected_reason="three readings in 0.6 s, a burst of 200 messages, and 2.1 s in which nothing is logged again",
)
