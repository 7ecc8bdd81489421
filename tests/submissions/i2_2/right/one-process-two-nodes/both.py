import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String


def main():
    rclpy.init()
    speaker, hearer = Node('speaker'), Node('hearer')
    pub = speaker.create_publisher(String, 'talk', 10)
    speaker.create_timer(0.5, lambda: pub.publish(String(data='tick')))

    async def hear(message):
        hearer.get_logger().info('reçu : ' + message.data)

    hearer.create_subscription(String, 'talk', hear, 10, callback_group=ReentrantCallbackGroup())
    executor = MultiThreadedExecutor()
    executor.add_node(speaker)
    executor.add_node(hearer)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()
