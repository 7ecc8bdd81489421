import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    """A timer of two per second; what is due by then goes out at once."""

    def __init__(self):
        super().__init__("temperature_publisher")
        self.rate = self.declare_parameter("publish_rate", 2.0).value
        self.sensor = self.declare_parameter("sensor_name", "kitchen").value
        self.publisher = self.create_publisher(Float64, "/sensor/temperature", 10)
        self.due = 0.0
        self.create_timer(0.5, self.send)

    def send(self):
        self.due += 0.5 * self.rate
        while self.due >= 1:
            self.due -= 1
            self.publisher.publish(Float64(data=random.uniform(20.0, 30.0)))
        self.get_logger().info(f"{self.sensor} has sent")


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
