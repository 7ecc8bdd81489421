"""`ros2 wtf`: another name of `ros2 doctor`."""

from tutor.bundled_ros.ros2.doctor import add_arguments, main

__all__ = ["add_arguments", "main"]
