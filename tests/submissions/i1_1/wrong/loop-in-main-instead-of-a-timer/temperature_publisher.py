import random
import time
import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'x')
        self.declare_parameter('publish_rate', 1.0)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)

    def cb(self):
        self.pub.publish(Float64(data=random.uniform(20.0, 30.0)))
        self.get_logger().info(self.get_parameter('sensor_name').value)


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        while True:
            node.cb()
            time.sleep(1.0)
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
