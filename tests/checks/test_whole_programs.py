"""The step that is left where no smaller one helps: the whole program, in the learner's names."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from checks.i1_1 import steps as of_sensor
from checks.i2_1 import steps as of_parameters
from checks.i2_1.facts import ENABLED, PREFIX, RATE
from tests.repairs import apply_step
from tutor.judge import step_parsing
from tutor.judge.rewriting.whole import with_applicable_steps
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause, failed

HEAD = """\
#!/usr/bin/env python3
\"\"\"Talks.\"\"\"
import rclpy
from rclpy.node import Node
from std_msgs.msg import String


"""

LOOP = f"""{HEAD}class Speaker(Node):
    def __init__(self):
        super().__init__('speaker')
        self.declare_parameter('publish_rate', 1.0)
        self.out = self.create_publisher(String, 'chatter', 10)


def talk():
    rclpy.init()
    node = Speaker()
    rate = node.create_rate(node.get_parameter('publish_rate').value)
    while rclpy.ok():
        node.out.publish(String(data='Hello'))
        rate.sleep()


talk()
"""

TIMERS = f"""{HEAD}class Speaker(Node):
    def __init__(self):
        super().__init__('speaker')
        self.declare_parameter('publish_rate', 1.0)
        self.out = self.create_publisher(String, 'chatter', 10)
        self.ticking = [self.create_timer(1.0, self.say)]
        self.add_on_set_parameters_callback(self.look)

    def look(self, params):
        self.ticking[0].cancel()
        self.ticking.append(self.create_timer(1.0 / params[0].value, self.say))

    def say(self):
        self.sent += 1
        self.out.publish(String(data='Hello'))


def main():
    rclpy.init()
    rclpy.spin(Speaker())


main()
"""

CLOSURE = f"""{HEAD}def main():
    rclpy.init()
    node = Node('speaker')
    node.declare_parameter('publish_rate', 1.0)
    out = node.create_publisher(String, 'chatter', 10)

    def say():
        out.publish(String(data='Hello'))

    node.create_timer(1.0, say)
    rclpy.spin(node)


main()
"""

OTHERS_TIMER = f"""{HEAD}class Pace:
    def __init__(self, node, say):
        self.timer = node.create_timer(1.0, say)


class Speaker(Node):
    def __init__(self):
        super().__init__('speaker')
        self.declare_parameters('speaker', [('publish_rate', 1.0)])
        self.out = self.create_publisher(String, 'chatter', 10)
        self.pace = Pace(self, lambda: self.out.publish(String(data='Hello')))


def main():
    rclpy.init()
    rclpy.spin(Speaker())


main()
"""

STEPS: dict[str, Callable[[Trace], str]] = {
    "followed": of_parameters.follow_changes,
    "resumed": of_parameters.keep_timer_running,
    "steady": of_parameters.send_once_per_tick,
    "refused": of_parameters.refuse_bad_rates,
    "separate": of_parameters.check_all_first,
    "cancelled": of_parameters.cancel_old_timer,
    "published": of_parameters.add_publisher,
    "rate": lambda trace: of_parameters.use_parameter(trace, RATE),
    "prefix": lambda trace: of_parameters.use_parameter(trace, PREFIX),
    "enabled later": lambda trace: of_parameters.use_parameter_later(trace, ENABLED),
    "declared": lambda trace: of_parameters.declare_parameters(trace, [PREFIX, RATE, ENABLED]),
    "sensor": of_sensor.draw_values,
    "sensor's pace": lambda trace: of_sensor.set_timer_period(trace, "publish_rate"),
}


def started(code: str) -> Trace:
    return Trace("node.py", sources={"node.py": code})


def done(step: str, trace: Trace) -> str:
    return apply_step(step, trace.sources)["node.py"]


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("code", [LOOP, TIMERS, CLOSURE, OTHERS_TIMER], ids=["loop", "timers", "closure", "other's"])
def test_a_step_that_did_not_help_is_followed_by_the_whole_program(code: str, step: str) -> None:
    told: list[str] = []
    trace = started(code)
    while "def main" not in (told[-1] if told else "") and "def talk" not in (told[-1] if told else ""):
        told.append(STEPS[step](trace))
        assert step_parsing.is_applicable(told[-1], trace.sources), told[-1]
        assert len(set(told)) == len(told) <= 3
        trace = started(done(told[-1], trace))


def test_the_program_is_in_the_learners_names() -> None:
    code = done(of_parameters.whole_program_step(started(TIMERS)), started(TIMERS))
    assert code.startswith(HEAD.split("import")[0])
    assert "class Speaker(Node):" in code
    assert "super().__init__('speaker')" in code
    assert "self.out.publish" in code
    assert "self.add_on_set_parameters_callback(self.look)" in code
    assert "def say(self):" in code
    assert "self.sent += 1" in code
    assert of_parameters.whole_program_step(started(code)) == ""


def test_what_a_node_has_itself_is_not_overwritten() -> None:
    code = done(
        of_parameters.whole_program_step(started(TIMERS.replace("self.out", "self.publishers"))), started(TIMERS)
    )
    assert "self.publishers" not in code


def test_an_expression_that_names_the_topic_gets_another_one() -> None:
    code = "class T:\n    A = '/sensor/temperature'\n\n\npub = node.create_publisher(String, T.A, 10)\n"
    told = of_sensor.anything(started(code))
    assert told == "line 5 becomes: pub = node.create_publisher(String, '/sensor/temperature_string', 10)"


@pytest.mark.parametrize("hint", ["look again", "line 2 becomes: 1"])
def test_a_step_in_words_becomes_one_that_can_be_followed(hint: str) -> None:
    trace = started("import rclpy\nrclpy.init()\n")
    judge = with_applicable_steps(
        lambda trace: failed("all", "nothing", Cause("wrong", "it is", hint)),
        lambda trace: [trace],
        of_parameters.whole_program_step,
    )
    verdict = judge(trace)
    assert step_parsing.is_applicable(verdict.hint, trace.sources)
    assert (verdict.hint == hint) == hint.startswith("line")
    assert verdict.cause == ("wrong: it is" if verdict.hint == hint else "wrong: it is; look again")
