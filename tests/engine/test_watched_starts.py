"""The forms that watch a start without parameters, and that which sends messages, on real nodes."""

from __future__ import annotations

import re

import pytest

from tests.engine.helpers import NODE, Scene, assert_failed_for, statuses
from tutor.exercise import (
    AtLeast,
    EndsCleanly,
    FieldEquals,
    Form,
    LogsText,
    Node,
    Program,
    Receives,
    Topic,
    check,
    criterion,
)

COMMAND = Topic("/command", "geometry_msgs/msg/Twist", "linear.x")
DOUBLED = Topic("/doubled", "std_msgs/msg/Float32")
BATTERY = Topic("/battery", "std_msgs/msg/Float32")


@criterion("stops", "a command of 0 is logged as a stop, and published", watch=(DOUBLED,))
async def stops(node: Node) -> None:
    sent = await node.publish(COMMAND, linear={"x": 0.0})
    doubled = await node.next(DOUBLED, after=sent, skip=0)
    node.expect(doubled.data, 0.0, do="Publish twice the command.")
    await node.logs("stop", after=sent)


FORMS: tuple[Form, ...] = (
    LogsText("ready", "robot ready"),
    LogsText("warns", re.compile(r"battery at \d+"), severity="warn"),
    AtLeast("often", BATTERY, 10, within_s=3.0),
    FieldEquals("full", BATTERY, 0.9, within_s=1.0),
    FieldEquals("share", BATTERY, lambda value: 0.0 <= value <= 1.0, what="0 to 1", every=True, within_s=1.0),
    Receives("hears", COMMAND, (1.5, -2.25)),
    Receives("doubles", COMMAND, (0.3, 21.0), becomes=lambda value: 2 * value, shown_on=DOUBLED),
    stops,
    EndsCleanly("shutdown", bonus=True),
)
CHECK = check("t1", Program("node.py"), *FORMS)

ROBOT = """
from geometry_msgs.msg import Twist
from std_msgs.msg import Float32
from rclpy.qos import qos_profile_sensor_data

class Robot:
    level = 0.9
    period_s = 0.1
    factor = 2
    topic = "command"
    greeting = "Robot ready."
    qos = qos_profile_sensor_data

    def __init__(self):
        self.battery = node.create_publisher(Float32, "battery", 10)
        self.doubled = node.create_publisher(Float32, "doubled", 10)
        node.create_timer(self.period_s, self.tick)
        node.create_subscription(Twist, self.topic, self.hear, self.qos)
        self.log(self.greeting)
        self.warn("battery at 90 %")

    def tick(self):
        self.battery.publish(Float32(data=self.level))

    def hear(self, message):
        self.log(f"speed {message.linear.x:.2f}" if message.linear.x else "stop")
        self.doubled.publish(Float32(data=self.factor * message.linear.x))

    def log(self, text):
        node.get_logger().info(text)

    def warn(self, text):
        node.get_logger().warning(text)
"""


def robot(change: str = "pass") -> str:
    """A learner's node: the robot, with a change of the class before it is made."""
    return NODE.format(f"{ROBOT}\n{change}\nrobot = Robot()")


async def test_a_right_node_passes_with_one_start_for_all_that_is_only_watched(scene: Scene) -> None:
    result = await scene.judge(*CHECK.criteria, source=robot())
    assert set(statuses(result).values()) == {"passed"}, result
    assert len(scene.seen_domains) == 4


@pytest.mark.parametrize(
    "change",
    [
        "Robot.qos = 1",
        "Robot.greeting = 'ROBOT READY at last'",
        "Robot.warn = lambda self, text: node.get_logger().error(text)",
        "Robot.period_s = 0.2",
    ],
)
async def test_other_right_nodes_pass(scene: Scene, change: str) -> None:
    result = await scene.judge(*CHECK.criteria, source=robot(change))
    assert set(statuses(result).values()) == {"passed"}, result


@pytest.mark.parametrize(
    ("change", "criterion", "mistake", "words"),
    [
        ("Robot.greeting = 'Robot is up.'", "ready", "not-logged", "'robot ready'"),
        ("Robot.log = lambda self, text: print(text, flush=True)", "ready", "printed-not-logged", "in none of"),
        ("time.sleep(1000)", "ready", "no-spin", "in none of 0"),
        ("Robot.warn = Robot.log", "warns", "not-logged", "not at WARN"),
        ("Robot.period_s = 1.0", "often", "stops-publishing", "messages in"),
        ("Robot.tick = lambda self: None", "often", "no-messages", "no such message"),
        ("Robot.level = 0.8", "full", "wrong-values", "0.8"),
        ("Robot.level = 90.0", "share", "wrong-values", "90.0, not 0 to 1"),
        ("Robot.topic = 'commands'", "hears", "wrong-topic", "no subscription on /command"),
        ("Robot.log = lambda self, text: None", "hears", "nothing-received", "1.5"),
        ("Robot.hear = lambda self, message: time.sleep(100)", "hears", "blocked-executor", "1.5"),
        ("Robot.factor = 3", "doubles", "nothing-received", "0.6"),
        ("Robot.topic = 'commands'", "stops", "wrong-topic", "no subscription on /command"),
        ("Robot.factor = 3; Robot.log = lambda self, text: None", "stops", "not-logged", "'stop'"),
    ],
)
async def test_a_wrong_node_fails_what_it_breaks(
    scene: Scene, change: str, criterion: str, mistake: str, words: str
) -> None:
    alone = check("t1", Program("node.py"), *(form for form in FORMS if form.id == criterion))
    result = await scene.judge(*alone.criteria, source=robot(change))
    assert_failed_for(result, mistake, words)
