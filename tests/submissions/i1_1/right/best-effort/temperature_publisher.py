import numpy as np
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'np')
        self.declare_parameter('publish_rate', 4.0)
        self.rng = np.random.default_rng()
        self.pub = self.create_publisher(Float64, '/sensor/temperature', qos_profile_sensor_data)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)

    def tick(self):
        t = float(self.rng.uniform(20.0, 30.0))
        self.pub.publish(Float64(data=t))
        self.get_logger().info(f"{self.get_parameter('sensor_name').value}: {t:.2f}")


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
