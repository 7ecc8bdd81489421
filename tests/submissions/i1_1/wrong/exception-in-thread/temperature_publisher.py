import random
import time
import threading
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64


class Temp(Node):
    def __init__(self):
        super().__init__("t")
        self.hz = self.declare_parameter("publish_rate", 2.0).value
        self.nm = self.declare_parameter("sensor_name", "f").value
        self.p = self.create_publisher(Float64, "/sensor/temperature", 10)
        self.get_logger().info(self.nm)
        threading.Thread(target=self.loop, daemon=True).start()

    def loop(self):
        while True:
            self.p.publish(random.uniform(20, 30))
            time.sleep(1 / self.hz)


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
