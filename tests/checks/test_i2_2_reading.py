"""What a diagnosis reads from the learner's file."""

from __future__ import annotations

from checks.i2_2.reading import Source

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
    first, later = Source(CODE).calls("create_timer")
    assert (first.line, first.within, first.kept) == (8, "__init__", "self.timer")
    assert first.given == ("1.0 / self.rate", "self.tick")
    assert first.where == "line 8: self.create_timer(1.0 / self.rate, self.tick)"
    assert (later.argument(0, "period"), later.argument(1, "callback"), later.argument(2, "clock")) == (
        "2.0",
        "self.tick",
        "",
    )


def test_assignments_and_names() -> None:
    source = Source(CODE)
    assert source.assignments()[0] == ("self.rate", "self.get_parameter('rate').value")
    assert source.imports("random")
    assert source.imports("Base")
    assert not source.imports("Node")
    assert source.uses("count") == 1


def test_concatenated_texts() -> None:
    texts = set(Source(CODE).texts())
    assert ("'a'", "'/'", "self.name") in texts
    assert any(parts[-2:] == ("self.rate", "'!'") for parts in texts)


def test_an_unparsable_file_yields_nothing() -> None:
    for source in (Source(), Source("def ("), Source("\0")):
        assert source.calls("print") == []
        assert source.assignments() == []
        assert not source.imports("rclpy")
