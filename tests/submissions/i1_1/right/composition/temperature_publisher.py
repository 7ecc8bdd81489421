from dataclasses import dataclass
from functools import partial
from secrets import SystemRandom

import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64


@dataclass
class FakeSensor:
    low: float = 20.0
    high: float = 30.0

    def read(self) -> float:
        return SystemRandom().uniform(self.low, self.high)


def publish(node, pub, sensor, name):
    reading = sensor.read()
    pub.publish(Float64(data=reading))
    node.get_logger().info(f'{name} | {reading:.2f}')


def main():
    rclpy.init()
    node = rclpy.create_node('temperature_publisher')
    name = node.declare_parameter('sensor.name', 'fake').value
    rate = node.declare_parameter('timing.rate', 2.0).value
    pub = node.create_publisher(Float64, 'sensor/temperature', 10)
    node.create_timer(1.0 / rate, partial(publish, node, pub, FakeSensor(), name))
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
