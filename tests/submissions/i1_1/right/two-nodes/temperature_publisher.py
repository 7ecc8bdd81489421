import random

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Float64


class Settings(Node):
    def __init__(self):
        super().__init__('settings')
        self.declare_parameter('sensor_name', 'double')
        self.declare_parameter('publish_rate', 2.0)


class Output(Node):
    def __init__(self, settings):
        super().__init__('output')
        self.settings = settings
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / settings.get_parameter('publish_rate').value, self.tick)

    def tick(self):
        t = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=t))
        self.get_logger().info(f"{self.settings.get_parameter('sensor_name').value}: {t}")


def main():
    rclpy.init()
    ex = SingleThreadedExecutor()
    settings = Settings()
    ex.add_node(settings)
    ex.add_node(Output(settings))
    try:
        ex.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
