from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = Path(__file__).resolve().parent


def script(name):
    return Node(
        executable='python3',
        arguments=[str(HERE / name)],
        namespace=LaunchConfiguration('namespace'),
        remappings=[('news', LaunchConfiguration('topic'))],
        output='screen',
    )


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='news'),
        DeclareLaunchArgument('namespace', default_value=''),
        script('reporter.py'),
        script('reader.py'),
    ])
