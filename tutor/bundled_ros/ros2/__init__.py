"""A `ros2` command for machines without an installed ROS 2, limited to what the exercises need."""
