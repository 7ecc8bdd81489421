"""Mistakes between a class and its base class."""

from __future__ import annotations

import pytest

from tests.checks.builders import trace
from tutor.judge.causes.inheritance import diagnose_repeated_setup, diagnose_timer_of_base_class
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


PERIODIC = """
class Periodic(Node):
    def __init__(self):
        super().__init__("periodic")
        self.TIMER = self.create_timer(1.0, self.tick)
"""
RETIMED = """
class Publisher(Periodic):
    def __init__(self):
        self.__timer = None
        super().__init__()
        self.add_post_set_parameters_callback(self.apply)

    def apply(self, params):
        self.__timer.cancel()
        self.__timer = self.create_timer(1.0 / params[0].value, self.tick)
"""


@pytest.mark.parametrize(
    ("attribute", "line"),
    [
        ("__timer", "        super().__init__()\n        self.__timer = self._Periodic__timer\n"),
        ("timer", "        super().__init__()\n        self.__timer = self.timer\n"),
    ],
)
def test_a_timer_that_is_replaced_is_that_of_the_base_class(attribute: str, line: str) -> None:
    sources = {"node.py": RETIMED, "base.py": PERIODIC.replace("TIMER", attribute)}
    cause = diagnose_timer_of_base_class(trace(sources=sources))
    assert cause is not None
    assert line in apply_step(cause.hint, sources)["node.py"]


def test_a_timer_in_the_same_attribute_is_no_mistake() -> None:
    sources = {"node.py": RETIMED.replace("__timer", "timer"), "base.py": PERIODIC.replace("TIMER", "timer")}
    assert diagnose_timer_of_base_class(trace(sources=sources)) is None
