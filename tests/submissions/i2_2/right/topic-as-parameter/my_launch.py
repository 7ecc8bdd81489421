from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    topic = {'topic_name': LaunchConfiguration('topic')}
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='numbers'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='my_package', executable='counter', namespace=LaunchConfiguration('namespace'),
             parameters=[topic, {'step': 3}], output='screen'),
        Node(package='my_package', executable='adder', namespace=LaunchConfiguration('namespace'),
             parameters=[topic], output='screen', emulate_tty=True),
    ])
