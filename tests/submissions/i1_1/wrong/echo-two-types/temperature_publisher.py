import random
import rclpy
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64, String


class TemperaturePublisher(Node):
    def __init__(self, display):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'x')
        self.declare_parameter('publish_rate', 4.0)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        # in one context the second type was an error, so I made another
        self.text = display.create_publisher(String, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.cb)

    def cb(self):
        t = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=t))
        self.text.publish(String(data=f'{t:.1f} degrees'))
        self.get_logger().info(self.get_parameter('sensor_name').value)


def main():
    rclpy.init()
    other = Context()
    rclpy.init(context=other)
    display = Node('display', context=other)
    try:
        rclpy.spin(TemperaturePublisher(display))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown(context=other)
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
