import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64

ROOM_C = 20.0
HOT_C = 30.0


class WarmingPlate(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'plate')
        self.plate_c = ROOM_C
        self.publisher = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.heat)

    def heat(self):
        self.plate_c = min(self.plate_c + random.uniform(0.01, 0.3), HOT_C)
        self.publisher.publish(Float64(data=self.plate_c))
        self.get_logger().info(f"{self.get_parameter('sensor_name').value}: {self.plate_c:.2f}")


def main():
    rclpy.init()
    node = WarmingPlate()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
