"""The last resort, if no smaller step helps: the whole program, in the learner's own names."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from checks.i1_1 import steps as sensor_steps
from checks.i2_1 import steps as parameter_steps
from checks.i2_1.facts import ENABLED, PREFIX, RATE
from tests.repairs import apply_step
from tutor.judge import step_parsing
from tutor.judge.edits import apply as apply_edits
from tutor.judge.rewriting.node import started_node
from tutor.judge.rewriting.program import whole_program
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
    "followed": parameter_steps.follow_changes,
    "resumed": parameter_steps.keep_timer_running,
    "steady": parameter_steps.send_once_per_tick,
    "refused": parameter_steps.refuse_bad_rates,
    "separate": parameter_steps.check_all_first,
    "cancelled": parameter_steps.cancel_old_timer,
    "published": parameter_steps.add_publisher,
    "rate": lambda trace: parameter_steps.use_parameter(trace, RATE),
    "prefix": lambda trace: parameter_steps.use_parameter(trace, PREFIX),
    "enabled later": lambda trace: parameter_steps.use_parameter_later(trace, ENABLED),
    "declared": lambda trace: parameter_steps.declare_parameters(trace, [PREFIX, RATE, ENABLED]),
    "sensor": sensor_steps.draw_values,
    "sensor's pace": lambda trace: sensor_steps.set_timer_period(trace, "publish_rate"),
}


def started(code: str) -> Trace:
    return Trace("node.py", sources={"node.py": code})


def follow_step(step: str, trace: Trace) -> str:
    return apply_step(step, trace.sources)["node.py"]


def test_a_whole_program_keeps_what_its_argument_parser_is_told() -> None:
    told = "    parser.add_argument('--depth')\n    arguments = parser.parse_args()\n"
    spun = "    while rclpy.ok():\n        rclpy.spin_once(node)\n    node.destroy_node()\n"
    code = f"{HEAD}def main():\n    parser = ArgumentParser()\n{told}    rclpy.init()\n    node = Node('a')\n{spun}"
    written = apply_edits(code, whole_program(started_node(started(code))))
    assert told in written
    assert "rclpy.spin(node)" in written


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("code", [LOOP, TIMERS, CLOSURE, OTHERS_TIMER], ids=["loop", "timers", "closure", "other's"])
def test_a_step_that_did_not_help_is_followed_by_the_whole_program(code: str, step: str) -> None:
    suggested: list[str] = []
    trace = started(code)
    while not suggested or ("def main" not in suggested[-1] and "def talk" not in suggested[-1]):
        suggested.append(STEPS[step](trace))
        assert step_parsing.is_applicable(suggested[-1], trace.sources), suggested[-1]
        assert len(set(suggested)) == len(suggested) <= 3
        trace = started(follow_step(suggested[-1], trace))


def test_the_program_uses_the_learners_names() -> None:
    code = follow_step(parameter_steps.whole_program_step(started(TIMERS)), started(TIMERS))
    assert code.startswith(HEAD.split("import")[0])
    assert "class Speaker(Node):" in code
    assert "super().__init__('speaker')" in code
    assert "self.out.publish" in code
    assert "self.add_on_set_parameters_callback(self.look)" in code
    assert "def say(self):" in code
    assert "self.sent += 1" in code
    assert parameter_steps.whole_program_step(started(code)) == ""


def test_attributes_of_rclpys_node_are_not_overwritten() -> None:
    code = follow_step(
        parameter_steps.whole_program_step(started(TIMERS.replace("self.out", "self.publishers"))), started(TIMERS)
    )
    assert "self.publishers" not in code


def test_an_expression_for_the_topic_is_replaced_by_another_topic() -> None:
    code = "class T:\n    A = '/sensor/temperature'\n\n\npub = node.create_publisher(String, T.A, 10)\n"
    step = sensor_steps.find_any_step(started(code))
    assert step == "line 5 becomes: pub = node.create_publisher(String, '/sensor/temperature_string', 10)"


@pytest.mark.parametrize("hint", ["look again", "line 2 becomes: 1"])
def test_a_step_in_words_becomes_an_applicable_one(hint: str) -> None:
    trace = started("import rclpy\nrclpy.init()\n")
    judge = with_applicable_steps(
        lambda trace: failed("all", "nothing", Cause("wrong", "it is", hint)),
        lambda trace: [trace],
        parameter_steps.whole_program_step,
    )
    verdict = judge(trace)
    assert step_parsing.is_applicable(verdict.step, trace.sources)
    assert (verdict.step == hint) == hint.startswith("line")
    assert verdict.cause == ("wrong: it is" if verdict.step == hint else "wrong: it is; look again")
