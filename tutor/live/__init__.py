"""What happens on the user's own ROS domain, watched by a process of its own: `python -m tutor.live`.

It reads commands and prints news, both as JSON lines (`tutor.live.protocol`), at a bounded rate whatever the topics do.
"""
