from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir


def generate_launch_description():
    launch_args = [
        DeclareLaunchArgument('topic', default_value='chatter', description='topic name'),
        DeclareLaunchArgument('namespace', default_value='', description='robot namespace'),
    ]

    # one include per robot, only one robot at the moment
    robots = [
        {'topic': LaunchConfiguration('topic'), 'namespace': LaunchConfiguration('namespace')},
    ]

    return LaunchDescription(launch_args + [
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource([ThisLaunchFileDir(), '/pair.launch.py']),
            launch_arguments=robot,
        ) for robot in robots
    ])
