"""B1.7 Find the Fault: a courier robot of four nodes with one fault, which is to be reported, and repaired."""

from __future__ import annotations

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

found = NamesFault("found", Faults.read(Path(__file__).resolve().parents[1] / "lessons" / "b1_7" / "cases.yaml"))
drives = LeadsTo("drives", ORDERS, POSITION, (("lab", 2.0), ("kitchen", 1.0)), within_s=6.0, stays_s=0.5)
position = KeepsRate("position", POSITION, 10.0)
battery = KeepsRate("battery", BATTERY, 2.0)
status = KeepsRate("status", STATUS, 1.0)
tells_position = Tells("tells-position", STATUS, POSITION, lambda x: f"at {x:.1f} m", after=(status, position))
tells_battery = Tells(
    "tells-battery",
    STATUS,
    BATTERY,
    lambda charge: "battery low" if charge < LOW_BELOW else "battery ok",
    ("battery ok", "battery low"),
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
    expected_s=6.5,
    expected_reason="the battery: 0.5 s until it is read, 5 s until it is low, 1 s until the status says so",
)
