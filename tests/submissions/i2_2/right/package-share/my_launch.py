import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = get_package_share_directory('my_package')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        Node(package='my_package', executable='minimal_publisher', namespace=LaunchConfiguration('namespace'),
             remappings=[('chatter', LaunchConfiguration('topic'))], output='screen',
             parameters=[os.path.join(share, 'config', 'params.yaml')]),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(PathJoinSubstitution(
            [FindPackageShare('my_package'), 'launch', 'subscriber_launch.py']))),
    ])
