from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, TimerAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def node(executable):
    return Node(package='my_package', executable=executable, namespace=LaunchConfiguration('namespace'),
                remappings=[('chatter', LaunchConfiguration('topic'))], output='both')


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        TimerAction(period=6.0, actions=[node('minimal_publisher'), node('slow_subscriber')]),
    ])
