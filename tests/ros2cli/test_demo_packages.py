"""A package of Python nodes in the manner of the official examples and demos runs from a workspace, as it is.

Actions with feedback and cancelling, a missed deadline, a lifecycle node that is led through its states, and nodes that
share a process: what people clone into `src` first.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from tests.ros2cli.bench import Bench, Ran
from tests.ros2cli.users import TUTOR, on_an_ordinary_domain, user_env

SETUP = """
from setuptools import find_packages, setup

package_name = "workshop_demos"

setup(
    name=package_name,
    version="1.0.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{package_name}"]),
        (f"share/{package_name}", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    entry_points={
        "console_scripts": [
            "countdown = workshop_demos.countdown:main",
            "count_from = workshop_demos.count_from:main",
            "late_metronome = workshop_demos.late_metronome:main",
            "drill = workshop_demos.drill:main",
            "operate_drill = workshop_demos.operate_drill:main",
            "bench_of_two = workshop_demos.bench_of_two:main",
        ],
    },
)
"""
PACKAGE_XML = """<?xml version="1.0"?>
<package format="3">
  <name>workshop_demos</name>
  <version>1.0.0</version>
  <description>Demos</description>
  <maintainer email="me@example.com">me</maintainer>
  <license>Apache-2.0</license>
  <exec_depend>rclpy</exec_depend>
  <export><build_type>ament_python</build_type></export>
</package>
"""
MODULES = {
    "__init__": "",
    "countdown": """
import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class Countdown(Node):
    def __init__(self):
        super().__init__("countdown")
        self.server = ActionServer(
            self, Fibonacci, "count_down",
            execute_callback=self.execute,
            goal_callback=lambda goal: GoalResponse.ACCEPT if goal.order < 100 else GoalResponse.REJECT,
            cancel_callback=lambda handle: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )
        self.rate = self.create_rate(50.0)

    def execute(self, handle):
        feedback = Fibonacci.Feedback()
        for number in range(handle.request.order, 0, -1):
            if handle.is_cancel_requested:
                handle.canceled()
                return Fibonacci.Result()
            feedback.sequence = [*feedback.sequence, number]
            handle.publish_feedback(feedback)
            self.rate.sleep()
        handle.succeed()
        return Fibonacci.Result(sequence=feedback.sequence)


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(Countdown(), executor=MultiThreadedExecutor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
""",
    "count_from": """
import sys

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient

NAMES = {GoalStatus.STATUS_SUCCEEDED: "succeeded", GoalStatus.STATUS_CANCELED: "canceled"}


def main(args=None):
    order = int(sys.argv[1])
    rclpy.init(args=args)
    node = rclpy.create_node("count_from")
    client = ActionClient(node, Fibonacci, "count_down")
    client.wait_for_server()
    heard = []
    sent = client.send_goal_async(
        Fibonacci.Goal(order=order), feedback_callback=lambda message: heard.append(message.feedback.sequence)
    )
    rclpy.spin_until_future_complete(node, sent)
    handle = sent.result()
    if not handle.accepted:
        print(order, "rejected")
        rclpy.shutdown()
        return
    if "--cancel" in sys.argv:
        while not heard:
            rclpy.spin_once(node)
        handle.cancel_goal_async()
    done = handle.get_result_async()
    rclpy.spin_until_future_complete(node, done)
    print(order, NAMES[done.result().status], list(done.result().result.sequence), "feedback:", bool(heard))
    rclpy.shutdown()
""",
    "late_metronome": """
import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.qos import LivelinessPolicy, QoSProfile
from std_msgs.msg import String

PROFILE = QoSProfile(depth=10, deadline=Duration(seconds=0.2), liveliness=LivelinessPolicy.AUTOMATIC)


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("late_metronome")
    missed = set()
    publisher = node.create_publisher(
        String, "tick", PROFILE,
        event_callbacks=PublisherEventCallbacks(deadline=lambda event: missed.add("offered")),
    )
    node.create_subscription(
        String, "tick", lambda message: None, PROFILE,
        event_callbacks=SubscriptionEventCallbacks(deadline=lambda event: missed.add("requested")),
    )
    publisher.publish(String(data="once"))
    while len(missed) < 2:
        rclpy.spin_once(node)
    print("missed:", *sorted(missed))
    rclpy.shutdown()
""",
    "drill": """
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from std_msgs.msg import String


class Drill(LifecycleNode):
    def on_configure(self, state):
        self.publisher = self.create_lifecycle_publisher(String, "turns", 10)
        self.timer = self.create_timer(0.05, lambda: self.publisher.publish(String(data="turn")))
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        self.destroy_timer(self.timer)
        self.destroy_publisher(self.publisher)
        return TransitionCallbackReturn.SUCCESS


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(Drill("drill"))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
""",
    "operate_drill": """
import rclpy
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from std_msgs.msg import String


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("operator")
    change = node.create_client(ChangeState, "drill/change_state")
    get = node.create_client(GetState, "drill/get_state")
    heard = []
    node.create_subscription(String, "turns", heard.append, 10)

    def ask(client, request):
        client.wait_for_service()
        answer = client.call_async(request)
        rclpy.spin_until_future_complete(node, answer)
        return answer.result()

    for transition in ("CONFIGURE", "ACTIVATE", "DEACTIVATE", "CLEANUP"):
        request = ChangeState.Request()
        request.transition.id = getattr(Transition, f"TRANSITION_{transition}")
        assert ask(change, request).success
        while transition == "ACTIVATE" and not heard:
            rclpy.spin_once(node)
        print(ask(get, GetState.Request()).current_state.label, bool(heard))
    rclpy.shutdown()
""",
    "bench_of_two": """
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Adder(Node):
    def __init__(self):
        super().__init__("adder")
        self.create_service(AddTwoInts, "add", self.add)

    def add(self, request, response):
        response.sum = request.a + request.b
        return response


class Asker(Node):
    def __init__(self, done):
        super().__init__("asker")
        self.done = done
        self.client = self.create_client(AddTwoInts, "add", callback_group=MutuallyExclusiveCallbackGroup())
        self.timer = self.create_timer(0.1, self.ask)

    async def ask(self):
        self.timer.cancel()
        self.client.wait_for_service()
        answer = await self.client.call_async(AddTwoInts.Request(a=40, b=2))
        print("sum:", answer.sum)
        self.done.set_result(True)


def main(args=None):
    rclpy.init(args=args)
    done = rclpy.Future()
    executor = MultiThreadedExecutor()
    for node in (Adder(), Asker(done)):
        executor.add_node(node)
    executor.spin_until_future_complete(done)
    rclpy.shutdown()
""",
}


@pytest.fixture(scope="module")
def bench(module_bench: Bench) -> Iterator[Bench]:
    with on_an_ordinary_domain(module_bench) as bench:
        yield bench


@pytest.fixture(scope="module")
def workspace(bench: Bench) -> Path:
    """A workspace into whose src folder somebody has put the package."""
    root = bench.folder / "demos_ws"
    package = root / "src/workshop_demos"
    (package / "resource").mkdir(parents=True)
    (package / "resource/workshop_demos").touch()
    (package / "setup.py").write_text(SETUP)
    (package / "package.xml").write_text(PACKAGE_XML)
    (package / "workshop_demos").mkdir()
    for name, text in MODULES.items():
        (package / f"workshop_demos/{name}.py").write_text(text)
    return root


def shell(bench: Bench, workspace: Path, script: str) -> Ran:
    environment: Mapping[str, str] = user_env(bench)
    ran = subprocess.run(
        [*TUTOR, "shell", "--workspace", str(workspace), "-c", f"set -m\n{script}"],  # so that Ctrl+C reaches all
        env=environment, cwd=os.fspath(bench.folder), capture_output=True, text=True, timeout=100, check=False,
    )  # fmt: skip
    return Ran(ran.stdout, ran.stderr, ran.returncode)


@pytest.mark.parametrize(
    ("script", "printed"),
    [
        (
            "ros2 run workshop_demos countdown & server=$!\n"
            "for goal in 3 500 '90 --cancel'; do ros2 run workshop_demos count_from $goal; done\n"
            "kill -INT -- -$server; wait $server; true",
            "3 succeeded [3, 2, 1] feedback: True\n500 rejected\n90 canceled [] feedback: True\n",
        ),
        ("ros2 run workshop_demos late_metronome", "missed: offered requested\n"),
        (
            "ros2 run workshop_demos drill & drill=$!\n"
            "ros2 run workshop_demos operate_drill\n"
            "kill -INT -- -$drill; wait $drill; true",
            "inactive False\nactive True\ninactive True\nunconfigured True\n",
        ),
        ("ros2 run workshop_demos bench_of_two", "sum: 42\n"),
    ],
    ids=["action", "deadline", "lifecycle", "two-nodes"],
)
def test_demos_run_as_they_are(bench: Bench, workspace: Path, script: str, printed: str) -> None:
    ran = shell(bench, workspace, script)
    assert (ran.stdout, ran.code) == (printed, 0), ran.stderr
