#!/usr/bin/env python3
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
        self.prefix = self.declare_parameter('message_prefix', 'Hello').value
        self.rate = self.declare_parameter('publish_rate', 1.0).value
        self.enabled = self.declare_parameter('enabled', True).value
        if self.rate <= 0:
            self.get_logger().warning(f'ignoring publish_rate {self.rate}, it must be positive')
            self.rate = 1.0
            self.set_parameters([rclpy.Parameter('publish_rate', value=self.rate)])
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.lock = threading.RLock()
        self.closed = False
        self.seq = 0
        self.pending = None
        self.arm(time.monotonic())
        self.add_on_set_parameters_callback(self.on_parameters)

    def arm(self, last):
        with self.lock:
            if self.closed:
                return
            if self.pending is not None:
                self.pending.cancel()
            due = last + 1.0 / self.rate
            self.pending = threading.Timer(
                max(0.0, due - time.monotonic()), self.fire, (due,))
            self.pending.daemon = True
            self.pending.start()

    def fire(self, due):
        with self.lock:
            if threading.current_thread() is not self.pending or self.closed:
                return
            if self.enabled and rclpy.ok():
                self.pub.publish(String(data=f'{self.prefix} {self.seq}'))
                self.seq += 1
            self.arm(due)

    def on_parameters(self, params):
        new = {p.name: p.value for p in params}
        if new.get('publish_rate', 1.0) <= 0:
            return SetParametersResult(successful=False, reason='The rate must be positive')
        with self.lock:
            self.prefix = new.get('message_prefix', self.prefix)
            self.enabled = new.get('enabled', self.enabled)
            if 'publish_rate' in new:
                self.rate = new['publish_rate']
                self.arm(time.monotonic())
        return SetParametersResult(successful=True)

    def close(self):
        with self.lock:
            self.closed = True
            self.pending.cancel()


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.close()
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
