from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    print('\n'.join(f'preparing step {i}' for i in range(200)))
    topic = LaunchConfiguration('topic')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='alarm'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='my_package', executable='alarm', remappings=[('chatter', topic)],
             namespace=LaunchConfiguration('namespace'), output='screen'),
        Node(package='my_package', executable='minimal_subscriber', remappings=[('chatter', topic)],
             namespace=LaunchConfiguration('namespace'), output='screen'),
    ])
