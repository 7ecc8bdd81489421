import random
import threading
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'thread')
        self.declare_parameter('publish_rate', 2.0)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.done = threading.Event()
        self.thread = threading.Thread(target=self.work)
        self.thread.start()

    def work(self):
        period = 1.0 / self.get_parameter('publish_rate').value
        while not self.done.wait(period):
            if not rclpy.ok():
                break
            value = random.uniform(20.0, 30.0)
            self.pub.publish(Float64(data=value))
            self.get_logger().info(f"{self.get_parameter('sensor_name').value}: {value}")


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.done.set()
        node.thread.join()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
