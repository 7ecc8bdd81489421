"""A set-up method that a class calls although its base class has called it."""

from __future__ import annotations

import pytest

from tests.checks.builders import trace
from tutor.judge.causes.repeated_setup import diagnose_repeated_setup
from tutor.judge.step_parsing import apply_step

BASE = """
class Base(Node):
    def __init__(self, name):
        super().__init__(name)
        self.set_up()

    def listen(self, topic, callback):
        self.create_subscription(String, topic, callback, 10)
"""
DERIVED = """
class Stats(Base):
    def __init__(self):
        super().__init__("stats")
        self.count = 0
        self.set_up()

    def set_up(self):
        self.listen("chatter", self.heard)
"""


def test_the_second_call_is_removed_even_if_the_base_class_is_in_another_file() -> None:
    sources = {"node.py": DERIVED, "base.py": BASE}
    cause = diagnose_repeated_setup(trace(sources=sources), "create_subscription")
    assert cause is not None
    assert "Base.__init__ has called already" in str(cause)
    assert apply_step(cause.hint, sources)["node.py"].count("self.set_up()") == 0


@pytest.mark.parametrize(
    ("derived", "maker"),
    [
        (DERIVED.replace("        self.set_up()\n", ""), "create_subscription"),
        (DERIVED.replace("(Base)", "(Node)"), "create_subscription"),
        (DERIVED, "create_timer"),
    ],
)
def test_other_methods_and_classes_are_left_alone(derived: str, maker: str) -> None:
    assert diagnose_repeated_setup(trace(sources={"node.py": derived, "base.py": BASE}), maker) is None
