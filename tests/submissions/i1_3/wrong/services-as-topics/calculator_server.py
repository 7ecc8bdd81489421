import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Int64, Int64MultiArray


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.pub = self.create_publisher(Int64, 'result', 10)
        for name in ('add', 'subtract', 'multiply', 'divide'):
            self.create_subscription(Int64MultiArray, name, getattr(self, name), 10)

    def add(self, msg):
        self.pub.publish(Int64(data=msg.data[0] + msg.data[1]))

    def subtract(self, msg):
        self.pub.publish(Int64(data=msg.data[0] - msg.data[1]))

    def multiply(self, msg):
        self.pub.publish(Int64(data=msg.data[0] * msg.data[1]))

    def divide(self, msg):
        self.pub.publish(Int64(data=msg.data[0] // msg.data[1]))


def main():
    rclpy.init()
    try:
        rclpy.spin(CalculatorServer())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
