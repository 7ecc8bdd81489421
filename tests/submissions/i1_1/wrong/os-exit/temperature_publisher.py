import random
import os
import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class Temp(Node):
    def __init__(self):
        super().__init__("temp")
        self.declare_parameter("publish_rate", 2.0)
        self.period = 1.0 / self.get_parameter("publish_rate").value
        self.sensor = self.declare_parameter("sensor_name", "s1").value
        self.pub = self.create_publisher(Float64, "sensor/temperature", 10)
        self.timer = self.create_timer(self.period, self.tick)
        self.i = 0

    def tick(self):
        self.i += 1
        i = self.i
        v = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=float(v)))
        self.get_logger().info(f"{self.sensor}: {v:.2f}")


def main():
    rclpy.init()
    n = Temp()
    for _ in range(5):
        rclpy.spin_once(n, timeout_sec=1)
    os._exit(0)


main()
