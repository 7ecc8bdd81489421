from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def generate_launch_description():
    topic = LaunchConfiguration('topic')
    namespace = LaunchConfiguration('namespace')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='topic'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(
            package='my_package',
            executable='minimal_publisher.py',
            name='minimal_publisher',
            namespace=namespace,
            remappings=['topic', topic],
            output='console',
        ),
        Node(
            package='my_package',
            executable='minimal_subscriber.py',
            name='minimal_subscriber',
            namespace=namespace,
            remappings=['topic', topic],
            output='console',
        ),
    ])
