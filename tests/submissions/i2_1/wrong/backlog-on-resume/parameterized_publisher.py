import sys

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.prefix = self.declare_parameter('message_prefix', 'Hello').value
        self.rate = self.declare_parameter('publish_rate', 1.0).value
        self.enabled = self.declare_parameter('enabled', True).value
        if self.rate <= 0.0:
            self.get_logger().fatal(f'publish_rate has to be positive, not {self.rate}')
            sys.exit(1)
        self.count = 0
        self.backlog = []
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.tick)
        self.add_on_set_parameters_callback(self.on_set)

    def on_set(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.value <= 0.0:
                return SetParametersResult(successful=False, reason='publish_rate has to be positive')
        for p in params:
            if p.name == 'message_prefix':
                self.prefix = p.value
            elif p.name == 'enabled':
                self.enabled = p.value
            elif p.name == 'publish_rate':
                self.set_rate(p.value)
        return SetParametersResult(successful=True)

    def set_rate(self, rate):
        self.rate = rate
        self.destroy_timer(self.timer)
        self.timer = self.create_timer(1.0 / rate, self.tick)

    def tick(self):
        self.backlog.append(String(data=f'{self.prefix} #{self.count}'))
        while self.enabled and self.backlog:
            self.pub.publish(self.backlog.pop(0))
        self.get_logger().info(f'Published: {self.prefix} #{self.count}')
        self.count += 1


def main():
    rclpy.init()
    try:
        rclpy.spin(ParameterizedPublisher())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
