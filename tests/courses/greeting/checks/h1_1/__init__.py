"""H1.1 Greeter: a text on /greeting."""

from tutor.exercise import Contains, Program, Topic, check

GREETING = Topic("/greeting", "std_msgs/msg/String")

CHECK = check(
    "h1.1",
    Program("greeter.py"),
    Contains("greets", GREETING, "hello"),
    mistakes="checks.h1_1.mistakes",
)
