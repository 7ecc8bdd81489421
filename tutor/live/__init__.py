"""Behind the app's Live page: `python -m tutor.live` watches the user's own ROS domain in a process of its own.

It reads requests and prints updates, both as JSON lines (`tutor.live.protocol`), at a bounded rate whatever the topics
do.
"""
