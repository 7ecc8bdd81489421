"""The process behind the app's Live page: `python -m tutor.live` watches the user's own ROS domain.

It reads requests and prints updates, both as JSON lines (`tutor.live.protocol`). The rate of updates is bounded,
whatever the topics do.
"""
