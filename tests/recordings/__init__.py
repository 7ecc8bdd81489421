"""Recordings of checks: the facts of every submission, gathered once, judged again in a minute without ROS."""
