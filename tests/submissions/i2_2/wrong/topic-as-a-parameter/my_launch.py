from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    topic = LaunchConfiguration('topic')
    namespace = LaunchConfiguration('namespace')

    talker = Node(
        package='demo_nodes_py',
        executable='talker',
        name='talker',
        namespace=namespace,
        parameters=[{'topic': topic}],
        output='screen',
    )
    listener = Node(
        package='demo_nodes_py',
        executable='listener',
        name='listener',
        namespace=namespace,
        parameters=[{'topic': topic}],
        output='screen',
    )

    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        talker,
        listener,
    ])
