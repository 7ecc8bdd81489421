import launch
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
import launch_ros.actions
from launch_ros.actions import Node


def generate_launch_description():

    chat_topic = DeclareLaunchArgument("topic", default_value="robot-chatter")
    robot_namespace = DeclareLaunchArgument("namespace", default_value="")

    # robot side
    robot = Node(
        package="demo_nodes_cpp",
        executable="listener",
        name="robot",
        namespace=LaunchConfiguration("namespace"),
        remappings=[("chatter", LaunchConfiguration("topic"))],
        respawn=False,
        output="screen",
    )

    # laptop side, sends the orders
    laptop = launch_ros.actions.Node(
        package="demo_nodes_cpp",
        executable="talker",
        name="laptop",
        remappings=[("chatter", LaunchConfiguration("topic"))],
        output="screen",
    )

    return launch.LaunchDescription([
        chat_topic,
        robot_namespace,
        robot,
        laptop,
    ])
