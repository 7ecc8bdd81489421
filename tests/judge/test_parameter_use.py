"""Causes and steps about parameters, in the words of the learner's own code."""

from __future__ import annotations

import pytest

from tutor.judge import causes
from tutor.judge.causes import parameter_use, timers
from tutor.judge.reading import UNREAD, Source

NODE = """\
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.prefix = self.get_parameter('message_prefix').value
        self.rate = self.get_parameter('publish_rate').value
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.tick)
        self.add_on_set_parameters_callback(self.changed)

    def changed(self, params):
        for param in params:
            if param.name == 'publish_rate' and param.value <= 0.0:
                return SetParametersResult(successful=False, reason='must be > 0')
            if param.name == 'publish_rate':
                self.timer.cancel()
                self.timer = self.create_timer(1.0 / param.value, self.tick)
            if param.name == 'message_prefix':
                self.prefix = param.value
        return SetParametersResult(successful=True)

    def tick(self):
        self.publisher.publish(String(data=self.prefix))
"""
REGISTERED = "        self.add_on_set_parameters_callback(self.changed)\n"
REFUSED = """\
            if param.name == 'publish_rate' and param.value <= 0.0:
                return SetParametersResult(successful=False, reason='must be > 0')
"""
REPLACED = """\
            if param.name == 'publish_rate':
                self.timer.cancel()
                self.timer = self.create_timer(1.0 / param.value, self.tick)
"""


def changed(*pairs: tuple[str, str]) -> Source:
    """The node with something of it written otherwise."""
    code = NODE
    for old, new in pairs:
        assert old in code
        code = code.replace(old, new)
    return Source(code)


SETS_BACK = (
    "    def tick(self):\n",
    "    def tick(self):\n        self.set_parameters([Parameter('publish_rate', value=1.0)])\n",
)


@pytest.mark.parametrize(
    ("source", "cause", "step"),
    [
        (changed((REGISTERED, "")), "callback not registered", "self.add_on_set_parameters_callback(self.changed)"),
        (changed(("(self.changed)", "(self.changed([]))")), "callback not registered", "without the ()"),
        (
            changed(("    def tick", "    def changed(self, params):\n        pass\n\n    def tick")),
            "callback defined twice",
            "remove the one in line 28",
        ),
        (
            changed((REPLACED, "")),
            "timer not replaced",
            "if p.name == 'publish_rate':\n            self.timer.cancel()",
        ),
        (
            changed(
                (REPLACED, ""), ("self.timer = self.create_timer(1.0 / self.rate", "self.create_timer(1.0 / self.rate")
            ),
            "timer not replaced",
            "line 14: self.timer = self.create_timer(1.0 / self.rate, self.tick)",
        ),
        (
            changed(("1.0 / param.value", "1.0 / self.get_parameter('publish_rate').value")),
            "old value used",
            "line 23: write param.value instead of self.get_parameter('publish_rate').value",
        ),
        (changed(SETS_BACK), "value overwritten by the node", "remove this call in line 29"),
        (
            changed(("            if param.name == 'publish_rate':\n", "            if self.rate != self.rate:\n")),
            "timer not replaced",
            "the condition in line 21",
        ),
    ],
)
def test_timer_not_replaced(source: Source, cause: str, step: str) -> None:
    found = causes.timer_not_replaced("publish_rate", source)
    assert found.name == cause, found
    assert step in found.hint


@pytest.mark.parametrize(
    ("source", "cause", "step"),
    [
        (
            changed(SETS_BACK, ("'publish_rate', value=1.0", "'message_prefix', value='Hello'")),
            "value overwritten",
            "29",
        ),
        (
            changed(("    def tick(self):\n", "    def tick(self):\n        self.prefix = 'Hello'\n")),
            "value overwritten by the node",
            "remove line 29",
        ),
        (
            changed((REGISTERED, ""), ("    def changed", "    def unused"), ("SetParametersResult(s", "dict(s")),
            "parameter ignored",
            "begin tick (line 27) with: self.prefix = self.get_parameter('message_prefix').value",
        ),
        (changed(("param.name == 'message_prefix'", "param.name == 'prefix'")), "parameter ignored", "begin tick"),
        (
            changed(("                self.prefix = param.value", "                self.text = param.value")),
            "parameter ignored",
            "begin tick (line 28) with: self.prefix = self.get_parameter('message_prefix').value",
        ),
        (
            changed(("= param.value", "= self.get_parameter('message_prefix').value")),
            "old value used",
            "line 25: write param.value instead of self.get_parameter('message_prefix').value",
        ),
    ],
)
def test_not_followed(source: Source, cause: str, step: str) -> None:
    found = parameter_use.not_followed(source, "message_prefix")
    assert found is not None
    assert found.name.startswith(cause), found
    assert step in found.hint


@pytest.mark.parametrize(
    ("source", "cause", "step"),
    [
        (
            changed(("self.publisher = ", "self.prefix = 'Hello'\n        self.publisher = ")),
            "value overwritten by the node",
            "remove line 13",
        ),
        (
            changed(("'message_prefix', 'Hello')", "'message_prefix', 'Hello', ignore_override=True)")),
            "value overwritten by the node",
            "leave ignore_override=True out of line 9",
        ),
        (
            changed(("self.get_parameter('message_prefix').value", "'Hello'"), ("'message_prefix':", "'no':")),
            "parameter ignored",
            "put self.get_parameter('message_prefix').value where its value is to be used in tick (line 28)",
        ),
    ],
)
def test_not_read(source: Source, cause: str, step: str) -> None:
    found = parameter_use.not_read(source, "message_prefix")
    assert found is not None
    assert found.name == cause
    assert step in found.hint


@pytest.mark.parametrize(
    ("source", "says", "step"),
    [
        (changed((REFUSED, "")), "never says no", "begin changed (line 17) with:\nfor p in params:\n    if p.name =="),
        (changed(("param.value <= 0.0", "self.rate <= 0.0")), "has to look at the new value", "p.value <= 0.0"),
        (changed(("add_on_set", "add_post_set")), "cannot reject", "self.add_on_set_parameters_callback(self.check_p"),
        (changed((REGISTERED, ""), ("SetParametersResult(s", "dict(s")), "nothing can reject", "def check_parameters"),
        (changed((REGISTERED, "")), "nothing ever calls it", "register it in __init__"),
    ],
)
def test_not_refused(source: Source, says: str, step: str) -> None:
    found = parameter_use.not_refused(source, "publish_rate", 0.0)
    assert found is not None
    assert says in found.text
    assert step in found.hint


def test_a_missing_import_is_part_of_the_step() -> None:
    source = changed((REFUSED, ""), ("import SetParametersResult", "import SetParametersResult as Result"))
    found = parameter_use.not_refused(source, "publish_rate", 0.0)
    assert found is not None
    assert "from rcl_interfaces.msg import SetParametersResult" in found.hint


@pytest.mark.parametrize(
    ("source", "step"),
    [
        (
            changed(("1.0 / self.rate", "self.rate")),
            "line 14: self.timer = self.create_timer(1.0 / self.rate, self.tick)",
        ),
        (
            changed(("1.0 / param.value", "param.value")),
            "line 23: self.timer = self.create_timer(1.0 / param.value, self.tick)",
        ),
        (
            changed(("1.0 / self.rate", "self.rate * 1.0")),
            "line 14: self.timer = self.create_timer(1.0 / (self.rate * 1.0), self.tick)",
        ),
    ],
)
def test_rate_as_period(source: Source, step: str) -> None:
    assert causes.rate_as_period("publish_rate", source).hint == step


@pytest.mark.parametrize(
    ("source", "step"),
    [
        (changed(("                self.timer.cancel()\n", "")), "right before line 22: self.timer.cancel()"),
        (
            changed(("                self.timer = self", "                self")),
            "line 23: self.timer = self.create_timer(1.0 / param.value, self.tick)",
        ),
        (
            changed((" self.timer = self.create_timer(1.0 / self", " timer = self.create_timer(1.0 / self")),
            "line 14: self.timer = self.create_timer(1.0 / self.rate, self.tick)\nright before line 23",
        ),
    ],
)
def test_old_timer_kept(source: Source, step: str) -> None:
    assert causes.old_timer_kept(11.0, 10.0, source).hint.startswith(step)


def test_whole_division() -> None:
    found = timers.whole_division(changed(("1.0 / self.rate", "1 // self.rate")))
    assert found is not None
    assert found.hint == "line 14: write / instead of //, 1 / self.rate"
    assert timers.whole_division(Source(NODE)) is None


def test_a_range_that_leaves_good_values_out() -> None:
    reason = "Parameter publish_rate out of range Min: 1.0, Max: 5.0, value: 10.0"
    source = Source("FloatingPointRange(from_value=1.0, to_value=5.0, step=0.0)")
    found = causes.of_refusal(reason, {"publish_rate": 10.0}, source)
    assert (found.name, found.hint) == (
        "range too narrow",
        "line 1: FloatingPointRange(from_value=0.01, to_value=1000.0, step=0.0)",
    )


def test_without_a_source_the_plain_words_are_left() -> None:
    assert parameter_use.not_followed(UNREAD, "message_prefix") is None
    assert parameter_use.not_read(UNREAD, "message_prefix") is None
    assert parameter_use.checked_at_start(UNREAD, "publish_rate") is None
    assert "self.timer.cancel()" in causes.timer_not_replaced("publish_rate").hint


@pytest.mark.parametrize(
    ("source", "step"),
    [
        (changed(("1.0)", "1)")), "line 10: self.declare_parameter('publish_rate', 1.0)"),
        (changed(("'publish_rate'", "'rate'")), "write 'publish_rate' instead of 'rate', wherever"),
        (
            changed(("        self.declare_parameter('publish_rate', 1.0)\n", "")),
            "add to __init__: self.declare_parameter('publish_rate', 1.0)",
        ),
        (
            Source("self.declare_parameters('', [('publish_rate', 2.0)])"),
            "line 1: ('publish_rate', 1.0) in the list of declare_parameters",
        ),
    ],
)
def test_declared_right(source: Source, step: str) -> None:
    assert parameter_use.declared_right(source, "publish_rate", 1.0).startswith(step)


def test_a_refusal_without_a_reason() -> None:
    for code in ("", ", reason=''"):
        source = changed((", reason='must be > 0'", code))
        assert parameter_use.without_reason(source, "publish_rate") == (
            "line 20: SetParametersResult(successful=False, reason='publish_rate must be > 0')"
        )


def test_a_timer_that_is_ended_for_good() -> None:
    ended = "            if not self.on:\n                self.timer.cancel()\n"
    step = timers.ended_for_good(changed((REPLACED, ended)), "enabled")
    assert step is not None
    assert step.startswith("remove lines 21 to 22")
    assert "begin tick (line 27) with:\nif not self.get_parameter('enabled').value:\n    return" in step
    assert timers.ended_for_good(Source(NODE), "enabled") is None


@pytest.mark.parametrize(
    ("source", "step"),
    [
        (
            changed(("        self.publisher.publish(String(data=self.prefix))\n", "        pass\n")),
            "publisher.publish(msg)",
        ),
        (
            changed(("        self.timer = self.create_timer(1.0 / self.rate, self.tick)\n", ""), (REPLACED, "")),
            "add to the end of __init__: self.timer = self.create_timer(1.0 / self.rate, self.tick)",
        ),
        (changed(("1.0 / self.rate", "1000 / self.rate")), "line 14: self.timer = self.create_timer(1.0 / self.rate,"),
    ],
)
def test_a_publisher_that_sends_nothing(source: Source, step: str) -> None:
    found = timers.idle(source, "/chatter")
    assert found is not None
    assert step in found.hint


def test_a_period_that_is_turned_over() -> None:
    assert timers.as_rate(Source(NODE)) == "line 14: write self.rate instead of 1.0 / self.rate"
