import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Float64


class Drift(Node):
    def __init__(self):
        super().__init__('drift')
        self.sensor = self.declare_parameter('sensor_name', 'drift').value
        hz = self.declare_parameter('publish_rate', 5.0).value
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', qos)
        self.temp = 25.0
        self.create_timer(1.0 / hz, self.step)

    def step(self):
        self.temp += random.uniform(-1.0, 1.0)
        self.temp = max(20.0, min(30.0, self.temp))
        self.pub.publish(Float64(data=self.temp))
        self.get_logger().info(f'{self.sensor}: {self.temp:.2f}')


def main():
    rclpy.init()
    node = Drift()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
