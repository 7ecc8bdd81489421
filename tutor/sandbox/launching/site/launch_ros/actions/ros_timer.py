"""Actions after some time, by ROS's clock."""

from __future__ import annotations

from launch.actions.timer_action import TimerAction


class ROSTimer(TimerAction):
    """A timer on the clock of the launch's own node, which is the system's here: there is no simulated time."""
