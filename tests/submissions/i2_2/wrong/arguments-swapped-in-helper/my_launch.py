from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def demo_node(executable, name, topic, namespace):
    return Node(
        package="demo_nodes_cpp",
        executable=executable,
        name=name,
        namespace=namespace,
        remappings=[("chatter", topic)],
        output="screen",
    )


def generate_launch_description():
    topic_arg = DeclareLaunchArgument("topic", default_value="/talk")
    topic = LaunchConfiguration("topic")
    namespace_arg = DeclareLaunchArgument("namespace", default_value="bot")
    namespace = LaunchConfiguration("namespace")

    talker_node = demo_node("talker", "my_talker", topic, namespace)
    # refactored from two Node(...) blocks, see git log
    listener_node = demo_node("listener", "my_listener", namespace, topic)

    ld = LaunchDescription()
    ld.add_action(topic_arg)
    ld.add_action(namespace_arg)
    ld.add_action(talker_node)
    ld.add_action(listener_node)
    return ld
