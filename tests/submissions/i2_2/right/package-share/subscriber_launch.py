from launch import LaunchDescription
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    # The arguments are those of whoever includes this file.
    return LaunchDescription([
        Node(package='my_package', executable='minimal_subscriber', namespace=LaunchConfiguration('namespace'),
             remappings=[('chatter', LaunchConfiguration('topic'))], output='screen'),
    ])
