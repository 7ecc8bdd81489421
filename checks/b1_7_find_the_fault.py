"""B1.7 Find the Fault: a courier robot of four nodes with one fault, which is to be reported, and repaired."""

from __future__ import annotations

import re
from pathlib import Path

from tutor.exercise import (
    Endpoint,
    EndsCleanly,
    Faults,
    HasEndpoints,
    KeepsRate,
    LaunchFile,
    LeadsTo,
    NamesFault,
    Tells,
    Topic,
    check,
)

TEXT, POINT, READING = "std_msgs/msg/String", "geometry_msgs/msg/Point", "sensor_msgs/msg/BatteryState"

ORDERS = Topic("/courier/orders", TEXT)
POSITION = Topic("/courier/position", POINT, field="x", unit="m")
BATTERY = Topic("/courier/battery_state", READING, field="percentage")
STATUS = Topic("/courier/status", TEXT)

LOW_BELOW = 0.25


def says_position(text: str, x: float) -> bool:
    """Whether a number in the text is the position, rounded to a tenth of a metre or less."""
    return any(abs(float(number) - x) < 0.051 for number in re.findall(r"-?\d+(?:\.\d+)?", text))


def says_battery(text: str, charge: float) -> bool:
    """Whether the text says what the charge is."""
    return ("battery low" if charge < LOW_BELOW else "battery ok") in text


found = NamesFault("found", Faults.read(Path(__file__).resolve().parents[1] / "lessons" / "b1_7" / "cases.yaml"))
drives = LeadsTo("drives", ORDERS, POSITION, (("lab", 2.0), ("kitchen", 1.0)), within_s=6.0, stays_s=0.5, per_s=1.0)
position = KeepsRate("position", POSITION, 10.0)
battery = KeepsRate("battery", BATTERY, 2.0)
status = KeepsRate("status", STATUS, 1.0)
tells_position = Tells("tells-position", STATUS, POSITION, says_position, after=(status, position))
tells_battery = Tells(
    "tells-battery",
    STATUS,
    BATTERY,
    says_battery,
    ("battery ok", "battery low"),
    goes_on_s=2.2,
    after=(status, battery),
)

CHECK = check(
    "b1.7",
    LaunchFile("courier_launch.py"),
    found,
    drives,
    position,
    battery,
    status,
    tells_position,
    tells_battery,
    HasEndpoints(
        "as-handed-over",
        publishers=(
            Endpoint("/courier/battery", "/courier/battery_state", READING, "best_effort", "volatile"),
            Endpoint("/courier/planner", "/courier/goal", POINT, "reliable", "transient_local"),
            Endpoint("/courier/driver", "/courier/position", POINT, "reliable", "volatile"),
            Endpoint("/courier/monitor", "/courier/status", TEXT, "reliable", "volatile"),
        ),
        subscriptions=(
            Endpoint("/courier/planner", "/courier/orders", TEXT, "reliable", "volatile"),
            Endpoint("/courier/driver", "/courier/goal", POINT, "reliable", "transient_local"),
            Endpoint("/courier/monitor", "/courier/battery_state", READING, "best_effort", "volatile"),
            Endpoint("/courier/monitor", "/courier/position", POINT, "reliable", "volatile"),
        ),
        after=(found, drives, position, battery, status, tells_position, tells_battery),
    ),
    EndsCleanly("shutdown", bonus=True),
    expected_s=8.7,
    expected_reason="the battery: 0.5 s until it is read, 5 s until it is low, 3 s in which the status says so",
)
