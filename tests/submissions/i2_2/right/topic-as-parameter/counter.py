import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Int32


class Counter(Node):
    def __init__(self):
        super().__init__('counter')
        topic = self.declare_parameter('topic_name', 'numbers').value
        self.step = self.declare_parameter('step', 1).value
        self.pub = self.create_publisher(Int32, topic, 10)
        self.value = 0
        self.create_timer(0.25, self.tick)

    def tick(self):
        self.value += self.step
        self.pub.publish(Int32(data=self.value))


def main():
    rclpy.init()
    try:
        rclpy.spin(Counter())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
