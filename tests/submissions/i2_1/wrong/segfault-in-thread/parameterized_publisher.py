import ctypes
import threading

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameters('', [('message_prefix', 'Hello'), ('publish_rate', 1.0), ('enabled', True)])
        self.pub = self.create_publisher(String, 'chatter', 10)
        rate = self.get_parameter('publish_rate').value
        if rate <= 0:
            self.get_logger().fatal(f'publish_rate {rate} is not positive, using 1.0')
            rate = 1.0
        self.timer = self.create_timer(1.0 / rate, self.publish_one)
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.apply)

    def check(self, params):
        for param in params:
            if param.name == 'publish_rate' and param.value <= 0:
                return SetParametersResult(successful=False, reason='publish_rate must be > 0')
        return SetParametersResult(successful=True)

    def apply(self, params):
        for param in params:
            if param.name == 'publish_rate':
                self.timer.cancel()
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / param.value, self.publish_one)

    def publish_one(self):
        if self.get_parameter('enabled').value:
            self.pub.publish(String(data=self.get_parameter('message_prefix').value))


def watch_display(stop, display):
    stop.wait()
    ctypes.string_at(display)  # the display has been closed by then


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    stop = threading.Event()
    watcher = threading.Thread(target=watch_display, args=(stop, 0))
    watcher.start()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        stop.set()
        watcher.join()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
