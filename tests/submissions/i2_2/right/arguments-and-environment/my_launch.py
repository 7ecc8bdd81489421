from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, SetEnvironmentVariable
from launch.substitutions import EnvironmentVariable, LaunchConfiguration, TextSubstitution
from launch_ros.actions import Node


def generate_launch_description():
    topic = LaunchConfiguration('topic', default='chatter')
    remap = ['--ros-args', '-r', [TextSubstitution(text='chatter:='), topic]]
    return LaunchDescription([
        SetEnvironmentVariable('RCUTILS_COLORIZED_OUTPUT', '1'),
        DeclareLaunchArgument('namespace', default_value=EnvironmentVariable('MY_ROBOT', default_value='')),
        Node(package='demo_nodes_py', executable='talker', name='left', arguments=remap, output='screen',
             namespace=LaunchConfiguration('namespace')),
        Node(package='demo_nodes_cpp', executable='listener', name='right', arguments=remap, output='screen',
             namespace=LaunchConfiguration('namespace'), additional_env={'GREETING': 'hello'}),
    ])
