import random

import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from std_msgs.msg import Float64


class Thermometer(Node):
    def __init__(self):
        super().__init__('thermometer')
        self.declare_parameter('publish_rate', 2.0)
        self.declare_parameter('sensor_name', 'attic')
        self.readings = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.read)

    def read(self):
        value = random.uniform(20.0, 30.0)
        self.readings.publish(Float64(data=value))
        self.get_logger().info(f"{self.get_parameter('sensor_name').value}: {value:.1f}")


def main():
    rclpy.init()
    executor = EventsExecutor()
    executor.add_node(Thermometer())
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
