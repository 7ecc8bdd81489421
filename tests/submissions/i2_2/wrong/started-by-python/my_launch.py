import subprocess

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess


def generate_launch_description():
    for program in ('talker', 'listener'):
        subprocess.Popen(['ros2', 'run', 'demo_nodes_py', program], start_new_session=True)
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        ExecuteProcess(cmd=['sleep', '1000']),
    ])
