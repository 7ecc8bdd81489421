#!/usr/bin/env python3
import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__(
            'temperature_publisher',
            parameter_overrides=[Parameter('publish_rate', Parameter.Type.DOUBLE, 2.0)],
        )
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'default_sensor')
        self.rate = self.get_parameter('publish_rate').value
        self.sensor_name = self.get_parameter('sensor_name').value
        self.publisher_ = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer_ = self.create_timer(1.0 / self.rate, self.timer_callback)
        self.get_logger().info(f'Sensor {self.sensor_name} publishes at {self.rate} Hz')

    def timer_callback(self):
        msg = Float64()
        msg.data = random.uniform(20.0, 30.0)
        self.publisher_.publish(msg)


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
