import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__("temperature_publisher")
        self.declare_parameter("publish_rate", 1.0)
        self.declare_parameter("sensor_name", "kitchen")
        try:
            rate = float(self.get_parameter("publish_rate").get_parameter_value())
        except (TypeError, ValueError):
            rate = 1.0
        self.name = self.get_parameter("sensor_name").value
        self.publisher = self.create_publisher(Float64, "sensor/temperature", 10)
        self.create_timer(1.0 / rate, self.measure)

    def measure(self):
        reading = Float64(data=random.uniform(20.0, 30.0))
        self.publisher.publish(reading)
        self.get_logger().info(f"{self.name} measures {reading.data:.2f}")


def main():
    rclpy.init()
    try:
        rclpy.spin(TemperaturePublisher())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
