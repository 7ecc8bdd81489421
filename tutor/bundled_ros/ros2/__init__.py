"""The `ros2` command where no ROS 2 is installed: `launch` and `run`, as far as the exercises need them."""
