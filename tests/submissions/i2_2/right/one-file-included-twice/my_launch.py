from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir


def one(executable):
    return GroupAction([
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource([ThisLaunchFileDir(), '/one_node.launch.py']),
            launch_arguments={
                'executable': executable,
                'topic': LaunchConfiguration('topic'),
                'robot': LaunchConfiguration('namespace'),
            }.items(),
        ),
    ])


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        one('minimal_publisher'),
        one('minimal_subscriber'),
    ])
