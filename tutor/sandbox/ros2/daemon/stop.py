"""`ros2 daemon stop`."""

from tutor.sandbox.ros2.daemon.status import main

__all__ = ["main"]
