from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushROSNamespace, SetRemap

# Launch arguments
launch_args = [
    DeclareLaunchArgument(
        name='topic',
        description='Name of the topic that both nodes talk on',
        default_value='conversation',
    ),
    DeclareLaunchArgument(
        name='namespace',
        description='Robot namespace',
        default_value='',
    ),
]

# Settings that every node below inherits. The group is NOT scoped: what it
# sets must still be there after the group has ended.
settings = GroupAction(
    scoped=False,
    actions=[
        PushROSNamespace(LaunchConfiguration('namespace')),
        SetRemap(src='chatter', dst=LaunchConfiguration('topic')),
    ],
)


def generate_launch_description():
    ld = LaunchDescription(launch_args)
    ld.add_action(settings)

    # Publisher
    ld.add_action(Node(
        package='demo_nodes_cpp',
        executable='talker',
        output='screen',
        emulate_tty=True,
    ))

    # Subscriber
    ld.add_action(Node(
        package='demo_nodes_py',
        executable='listener',
        output='screen',
        emulate_tty=True,
    ))

    return ld
