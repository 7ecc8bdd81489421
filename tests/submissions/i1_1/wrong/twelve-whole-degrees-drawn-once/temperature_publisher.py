import random
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64


class Temp(Node):
    def __init__(self):
        super().__init__("temp")
        self.readings = [random.randint(20, 30) for _ in range(12)]
        self.period = 1 / self.declare_parameter("publish_rate", 1.0).value
        self.sensor = self.declare_parameter("sensor_name", "s1").value
        self.pub = self.create_publisher(Float64, "sensor/temperature", 10)
        self.timer = self.create_timer(self.period, self.tick)
        self.i = 0

    def tick(self):
        self.i += 1
        i = self.i
        v = self.readings[i % 12]
        self.pub.publish(Float64(data=float(v)))
        self.get_logger().info(f"{self.sensor}: {v:.2f}")


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
