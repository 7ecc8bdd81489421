"""X1.1 Street Lamp: a text on /street_lamp/status, twice a second."""

from tutor.exercise import Contains, Node, Program, Topic, check, criterion

STATUS = Topic("/street_lamp/status", "std_msgs/msg/String")

status = Contains("status", STATUS, "ready")


@criterion("rate", "two messages a second", watch=(STATUS,), after=status)
async def rate(node: Node) -> None:
    """Measure how often messages come."""
    await node.rate(STATUS, 2.0)


CHECK = check("x1.1", Program("street_lamp.py"), status, rate)
