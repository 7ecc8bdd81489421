## @file my_launch.py
# @brief Launch file that brings up the talker and the listener.
# @author T. Raman
# @date 11/14/2023
# @version 1.1

import launch
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


## @brief Generates the launch description for the talker and listener nodes.
#
# Arguments: topic (default chatter), namespace (default empty)
#
# @return A LaunchDescription object
def generate_launch_description():
    topic = LaunchConfiguration('topic')
    ns = LaunchConfiguration('namespace')

    return launch.LaunchDescription([
        DeclareLaunchArgument(name='topic', default_value='chatter'),
        DeclareLaunchArgument(name='namespace', default_value=''),

        ## tell the user what is going on
        LogInfo(msg='Launching Talker and Listener on topic: ' + topic),

        ## Node initialization for the 'talker' node.
        Node(
            package='demo_nodes_cpp',
            executable='talker',
            name='talker',
            namespace=ns,
            remappings=[('chatter', topic)],
        ),

        ## Node initialization for the 'listener' node.
        Node(
            package='demo_nodes_cpp',
            executable='listener',
            name='listener',
            namespace=ns,
            remappings=[('chatter', topic)],
        ),
    ])
