"""What happens on the user's own ROS domain, watched by a process of its own: `python -m tutor.live`.

It reads requests and prints updates, both as JSON lines (`tutor.live.protocol`), at a bounded rate whatever the topics
do.
"""
