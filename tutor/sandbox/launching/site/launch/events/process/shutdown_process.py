"""A process is to end."""

from .process_targeted_event import ProcessTargetedEvent


class ShutdownProcess(ProcessTargetedEvent):
    """The process is to end: SIGINT, and more if that does not help."""

    name = "launch.events.process.ShutdownProcess"
