from launch import LaunchDescription
from launch.actions import *
from launch.substitutions import *
def generate_launch_description():
    def run(s): return ExecuteProcess(cmd=['python3', [ThisLaunchFileDir(), '/', s], '--ros-args', '-r', ['chatter:=', LaunchConfiguration('topic')], '-r', ['__ns:=/', LaunchConfiguration('namespace')]], output='screen')
    return LaunchDescription([DeclareLaunchArgument('topic', default_value='chatter'), DeclareLaunchArgument('namespace', default_value=''), run('pub.py'), run('sub.py')])
