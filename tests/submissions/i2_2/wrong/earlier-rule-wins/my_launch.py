import os
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

# TODO(minho): 나중에 로봇별로 분리하기

def generate_launch_description():
    topic = LaunchConfiguration('topic')
    namespace = LaunchConfiguration('namespace')

    # 공통 리매핑
    common_remappings = [
        ('/tf', 'tf'),
        ('/tf_static', 'tf_static'),
        ('chatter', 'robot_news'),
    ]

    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='robot_news',
                              description='토픽 이름'),
        DeclareLaunchArgument('namespace', default_value='',
                              description='네임스페이스'),

        # ===== 퍼블리셔 =====
        Node(
            package='demo_nodes_cpp',
            executable='talker',
            name='news_publisher',
            namespace=namespace,
            remappings=common_remappings + [('chatter', topic)],
            output='screen',
        ),

        # ===== 서브스크라이버 =====
        Node(
            package='demo_nodes_cpp',
            executable='listener',
            name='news_subscriber',
            namespace=namespace,
            remappings=common_remappings + [('chatter', topic)],
            output='screen',
        ),
    ])
