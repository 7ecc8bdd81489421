import random
import time
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64


class Temp(Node):
    def __init__(self):
        super().__init__("t")
        self.declare_parameter("publish_rate", 2.0)
        self.declare_parameter("sensor_name", "f")
        self.p = self.create_publisher(Float64, "/sensor/temperature", 10)
        self.next = time.monotonic()
        self.create_timer(0.01, self.poll)

    def poll(self):
        if time.monotonic() >= self.next:
            self.next += 1 / self.get_parameter("publish_rate").value
            self.p.publish(Float64(data=random.uniform(20, 30)))
            self.get_logger().info(
                self.get_parameter("sensor_name").value, throttle_duration_sec=2.0
            )


def main():
    rclpy.init()
    node = Temp()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
