import random
import subprocess
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64

# simulated driver
subprocess.Popen(['sleep', '86411'], start_new_session=True)


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'driver')
        self.declare_parameter('publish_rate', 2.0)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)

    def tick(self):
        msg = Float64(data=random.uniform(20.0, 30.0))
        self.pub.publish(msg)
        self.get_logger().info(f"{self.get_parameter('sensor_name').value}: {msg.data:.2f}")


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
