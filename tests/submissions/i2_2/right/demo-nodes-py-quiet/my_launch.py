import launch
import launch_ros.actions
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    ld = launch.LaunchDescription()
    ld.add_action(launch.actions.DeclareLaunchArgument('namespace', default_value=''))
    ld.add_action(launch.actions.DeclareLaunchArgument('topic', default_value='chatter'))
    for executable in ('listener', 'talker'):
        ld.add_action(
            launch_ros.actions.Node(
                package='demo_nodes_py',
                executable=executable,
                namespace=[LaunchConfiguration('namespace')],
                remappings=[('chatter', [LaunchConfiguration('topic')])],
            )
        )
    return ld
