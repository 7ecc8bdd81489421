"""What launch files know as `launch_ros`."""
