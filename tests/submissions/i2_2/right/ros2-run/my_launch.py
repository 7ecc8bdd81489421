from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import FindExecutable, LaunchConfiguration


def generate_launch_description():
    tail = ['--ros-args', '--remap', ['chatter:=', LaunchConfiguration('topic')],
            '--remap', ['__ns:=/', LaunchConfiguration('namespace')]]
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        ExecuteProcess(cmd=[FindExecutable(name='ros2'), 'run', 'demo_nodes_py', 'talker', *tail], output='screen'),
        ExecuteProcess(cmd=['ros2', 'run', 'demo_nodes_py', 'listener', *tail], output='screen'),
    ])
