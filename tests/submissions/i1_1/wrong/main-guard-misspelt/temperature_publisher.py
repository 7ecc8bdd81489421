#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from random import uniform
from std_msgs.msg import Float64
class Temperature(Node):
    def __init__(self):
        super().__init__("temperature_publisher")
        self.declare_parameter("sensor_name", "T1")
        self.declare_parameter("rate", 2.0)
        self.sensor = self.get_parameter("sensor_name").value
        rate = self.get_parameter("rate").value
        self.publisher = self.create_publisher(Float64, "/sensor/temperature", 10)
        self.timer = self.create_timer(1.0/rate, self.add_temperature)
    def add_temperature(self):
        msg = Float64()
        msg.data = uniform(20,30)
        self.publisher.publish(msg)
        self.get_logger().info(f"{self.sensor} -> {msg.data:.2f}")
def main(args = None):
    rclpy.init(args = args)
    node = Temperature()
    rclpy.spin(node)
    rclpy.shutdown()

if __name__ == 'main':
    main()
