from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    args = [DeclareLaunchArgument('topic', default_value='map_name'),
            DeclareLaunchArgument('namespace', default_value='')]
    nodes = [
        Node(package='my_package', executable=program, namespace=LaunchConfiguration('namespace'), output='screen',
             remappings=[('map_name', LaunchConfiguration('topic'))])
        for program in ('map_server', 'map_reader')
    ]
    return LaunchDescription(args + nodes)
