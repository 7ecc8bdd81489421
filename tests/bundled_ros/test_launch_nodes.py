"""Launch files whose actions need a ROS node in the launch process, run with real nodes."""

from __future__ import annotations

import pytest

from tests.ros2cli.bench import Bench

NODE = """
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn


class Lamp(LifecycleNode):
    def on_configure(self, state):
        self.get_logger().info("configured")
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        self.get_logger().info("activated")
        return TransitionCallbackReturn.SUCCESS


def main():
    rclpy.init()
    try:
        rclpy.spin(Lamp("unnamed"))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
"""

IMPORTS = """
from launch import LaunchDescription
from launch.actions import EmitEvent, LogInfo, RegisterEventHandler, Shutdown
from launch.conditions import IfCondition
from launch.events import matches_action
from launch_ros.actions import *
from launch_ros.descriptions import ComposableNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events import matches_node_name
from launch_ros.events.lifecycle import ChangeState
from launch_ros.substitutions import Parameter
from lifecycle_msgs.msg import Transition


def generate_launch_description():
    lamp = LifecycleNode(package="my_package", executable="lamp", name="lamp", namespace="", output="screen")
    seen = OnStateTransition(target_lifecycle_node=lamp, goal_state="active", entities=[LogInfo(msg="on"), Shutdown()])
"""

BY_EVENTS = """
    activate = ChangeState(lifecycle_node_matcher=matches_action(lamp), transition_id=Transition.TRANSITION_ACTIVATE)
    configured = OnStateTransition(
        target_lifecycle_node=lamp, start_state="configuring", goal_state="inactive",
        entities=[LogInfo(msg="ready"), EmitEvent(event=activate)],
    )
    configure = ChangeState(lifecycle_node_matcher=matches_node_name("lamp"), transition_id=1)
    return LaunchDescription([
        lamp, RegisterEventHandler(configured), RegisterEventHandler(seen), EmitEvent(event=configure),
    ])
"""

BY_TRANSITIONS = """
    both = LifecycleTransition(lifecycle_node_names=["/lamp"], transition_ids=[1, Transition.TRANSITION_ACTIVATE])
    return LaunchDescription([lamp, RegisterEventHandler(seen), both])
"""


def launch(bench: Bench, text: str, name: str = "my_launch.py") -> tuple[int, str]:
    """Run a launch file beside a lifecycle node. Return the exit code and all output."""
    (bench.folder / "lamp.py").write_text(NODE)
    (bench.folder / name).write_text(text)
    ran = bench.ros2("launch", "-n", name)
    return ran.code, ran.stdout + ran.stderr


@pytest.mark.parametrize(("text", "messages"), [(BY_EVENTS, ["ready", "on"]), (BY_TRANSITIONS, ["on"])])
def test_a_lifecycle_node_goes_through_its_states(bench: Bench, text: str, messages: list[str]) -> None:
    code, out = launch(bench, IMPORTS + text)
    assert [line.partition("]: ")[2] for line in out.splitlines() if "[launch.user]" in line] == messages, out
    for state in ("configured", "activated"):
        assert f"[lamp]: {state}" in out
    assert "process has finished cleanly" in out
    assert code == 0


@pytest.mark.parametrize(
    ("actions", "error"),
    [
        (
            "[ComposableNodeContainer(package='rclcpp_components', executable='component_container', name='c', "
            "namespace='', composable_node_descriptions=[ComposableNode(package='demo', plugin='demo::Talker')])]",
            "loading the composable node demo::Talker into a container is not supported",
        ),
        (
            "[ComposableNodeContainer(package='rclcpp_components', executable='component_container', name='c', "
            "namespace='')]",
            "a container of rclcpp_components is not supported",
        ),
        (
            "[LoadComposableNodes(target_container='c', composable_node_descriptions=[ComposableNode(package='demo', "
            "plugin='demo::Talker')])]",
            "loading the composable node demo::Talker into a container is not supported",
        ),
        (
            "[ComposableNodeContainer(package='demo_nodes_py', executable='nowhere', name='c', namespace='', "
            "composable_node_descriptions=[ComposableNode(package='demo', plugin='demo::Talker', "
            "condition=IfCondition('false'))])]",
            "executable 'nowhere' not found in package 'demo_nodes_py'",
        ),
    ],
)
def test_component_containers_are_refused(bench: Bench, actions: str, error: str) -> None:
    code, out = launch(bench, f"{IMPORTS}    return LaunchDescription({actions})")
    errors = [line for line in out.splitlines() if line.startswith("[ERROR]")]
    assert len(errors) == 1
    assert error in errors[0]
    assert code == 1


def test_other_actions_of_launch_ros_in_xml(bench: Bench) -> None:
    text = """<launch>
    <set_parameter name="rate" value="5"/><log message="rate $(param rate), $(param nowhere none)"/>
    <group><set_ros_log_dir new_log_dir="deep"/>
    <executable cmd="printenv ROS_LOG_DIR" output="screen" name="p"/></group>
    <ros_timer period="0.1"><log message="later"/></ros_timer>
    <load_composable_node target="c"><composable_node pkg="a" plugin="b" name="c" if="false"/></load_composable_node>
    </launch>"""
    code, out = launch(bench, text, "my.launch.xml")
    assert "[launch.user]: rate 5, none\n" in out
    assert f"[p-1] {bench.folder}/log/deep\n" in out
    assert "[launch.user]: later\n" in out
    assert code == 0
