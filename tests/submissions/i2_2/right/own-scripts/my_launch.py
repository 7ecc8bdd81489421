from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration

HERE = Path(__file__).resolve().parent


def script(name):
    return ExecuteProcess(
        cmd=[
            'python3', str(HERE / name), '--ros-args',
            '-r', ['gespraech:=', LaunchConfiguration('topic')],
            '-r', ['__ns:=/', LaunchConfiguration('namespace')],
        ],
        output='screen',
    )


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='gespraech'),
        DeclareLaunchArgument('namespace', default_value=''),
        script('sprecher.py'),
        script('hoerer.py'),
    ])
