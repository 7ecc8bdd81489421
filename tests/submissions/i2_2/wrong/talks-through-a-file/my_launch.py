from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir
import sys


def run(script):
    return ExecuteProcess(
        cmd=[sys.executable, PathJoinSubstitution([ThisLaunchFileDir(), script]),
             '--ros-args', '-r', ['chatter:=', LaunchConfiguration('topic')],
             '-r', ['__ns:=/', LaunchConfiguration('namespace')]],
        output='screen')


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        run('pub.py'),
        run('sub.py'),
    ])
