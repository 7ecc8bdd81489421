import launch
import launch.actions
import launch.substitutions
import launch_ros.actions


def generate_launch_description():
    return launch.LaunchDescription([
        launch.actions.DeclareLaunchArgument(
            'topic',
            default_value='chatter',
            description='Topic name.'),
        launch.actions.DeclareLaunchArgument(
            'namespace',
            default_value='',
            description='Namespace of the nodes.'),
        launch_ros.actions.Node(
            package='demo_nodes_cpp',
            node_namespace=launch.substitutions.LaunchConfiguration('namespace'),
            node_executable='talker',
            node_name='talker',
            remappings=[('chatter', launch.substitutions.LaunchConfiguration('topic'))],
            output='screen'),
        launch_ros.actions.Node(
            package='demo_nodes_cpp',
            node_namespace=launch.substitutions.LaunchConfiguration('namespace'),
            node_executable='listener',
            node_name='listener',
            remappings=[('chatter', launch.substitutions.LaunchConfiguration('topic'))],
            output='screen'),
    ])
