"""B1.6 At the Right Level: a battery monitor that logs each event at the level that it deserves."""

from __future__ import annotations

from tutor.exercise import EndsCleanly, Program, Receives, Topic, check

BATTERY = Topic("/battery", "sensor_msgs/msg/BatteryState", "percentage")

CHECK = check(
    "b1.6",
    Program("battery_monitor.py"),
    Receives("readings", BATTERY, (0.83, 0.47)),
    EndsCleanly("shutdown", bonus=True),
)
