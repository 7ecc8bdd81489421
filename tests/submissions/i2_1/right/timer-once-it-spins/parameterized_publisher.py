import sys
import threading
import time

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        if self.get_parameter('publish_rate').value <= 0:
            raise ValueError('publish_rate must be greater than 0')
        self.count = 0
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.add_on_set_parameters_callback(self.on_change)

    def begin(self):
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.publish)
        if not self.get_parameter('enabled').value:
            self.timer.cancel()

    def on_change(self, parameters):
        for parameter in parameters:
            if parameter.name == 'publish_rate' and parameter.value <= 0:
                return SetParametersResult(successful=False, reason='publish_rate must be greater than 0')
        for parameter in parameters:
            if parameter.name == 'publish_rate':
                self.timer.timer_period_ns = int(1e9 / parameter.value)
            if parameter.name == 'enabled' and parameter.value:
                self.timer.reset()
            elif parameter.name == 'enabled':
                self.timer.cancel()
        return SetParametersResult(successful=True)

    def publish(self):
        self.count += 1
        prefix = self.get_parameter('message_prefix').value
        self.publisher.publish(String(data=f'{prefix}: {self.count}'))


def spin(node):
    try:
        rclpy.spin(node)
    except ExternalShutdownException:
        pass


def main():
    rclpy.init()
    try:
        node = ParameterizedPublisher()
    except ValueError as error:
        sys.exit(str(error))
    thread = threading.Thread(target=spin, args=(node,))
    thread.start()
    try:
        time.sleep(2.0)  # whatever it is that it needs first
        node.begin()
        while rclpy.ok():
            time.sleep(0.1)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
        thread.join()


if __name__ == '__main__':
    main()
