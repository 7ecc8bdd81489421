from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument(name='namespace', default_value='/'),
        DeclareLaunchArgument(name='topic', default_value='front/words'),
        Node(package='demo_nodes_py', executable='talker', namespace=LaunchConfiguration('namespace'),
             remappings={'chatter': LaunchConfiguration('topic')}.items(), output='screen'),
        Node(package='demo_nodes_py', executable='listener', namespace=LaunchConfiguration('namespace'),
             remappings={'chatter': LaunchConfiguration('topic')}.items(), output='screen'),
    ])
