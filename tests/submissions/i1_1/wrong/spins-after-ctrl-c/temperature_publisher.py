import random

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('publish_rate', 2.0)
        self.declare_parameter('sensor_name', 'roof')
        self.sensor = self.get_parameter('sensor_name').value
        self.pub = self.create_publisher(Float64, 'sensor/temperature', 10)
        self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.publish)

    def publish(self):
        t = round(random.uniform(20.0, 30.0), 2)
        self.pub.publish(Float64(data=t))
        self.get_logger().info(f'{self.sensor} {t}')


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    executor.add_node(TemperaturePublisher())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        # one more round, so that nothing is lost
        executor.spin_once()


if __name__ == '__main__':
    main()
