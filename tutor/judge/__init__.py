"""Judging: criteria, verdicts, causes and events. Knows neither ROS nor processes."""
