"""The base of all events."""


class Event:
    """Something that has happened, or is asked for, while a launch file runs."""

    name = "launch.Event"
