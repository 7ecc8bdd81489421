"""`ros2 daemon stop`."""

from tutor.bundled_ros.ros2.daemon.status import main

__all__ = ["main"]
