"""What a diagnosis reads from the learner's file."""

from __future__ import annotations

from tutor.source.launch_file import LaunchFile

CODE = """\
import random
from rclpy.node import Node as Base


class Sensor(Base):
    def __init__(self):
        self.rate = self.get_parameter('rate').value
        self.timer = self.create_timer(1.0 / self.rate, self.tick)
        self.restart()

    def restart(self):
        if self.rate > 5:
            self.timer = self.create_timer(period=2.0, callback=self.tick)

    def tick(self, count: int = 0):
        print(f'{count}: ' + str(self.rate) + '!', '/'.join(['a', self.name]))

    def tick(self):
        pass
"""


def test_calls_with_arguments_and_context() -> None:
    first, later = LaunchFile(CODE).calls("create_timer")
    assert (first.line, first.within, first.kept) == (8, "__init__", "self.timer")
    assert first.given == ("1.0 / self.rate", "self.tick")
    assert first.where == "line 8: self.create_timer(1.0 / self.rate, self.tick)"
    assert (later.argument(0, "period"), later.argument(1, "callback"), later.argument(2, "clock")) == (
        "2.0",
        "self.tick",
        "",
    )


def test_how_often_a_name_is_read() -> None:
    assert LaunchFile(CODE).uses("count") == 1


def test_an_unparsable_file_yields_nothing() -> None:
    for source in (LaunchFile(), LaunchFile("def ("), LaunchFile("\0")):
        assert source.calls("print") == []
