#!/usr/bin/env python3
import math
import signal
import sys
import threading

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('talker_with_parameters')
        self.declare_parameters('', [
            ('message_prefix', 'Hello'),
            ('publish_rate', 1.0),
            ('enabled', True),
        ])
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.timer = None
        self.message = String()
        self.number = 0
        hz = self.get_parameter('publish_rate').value
        if self.is_rate(hz):
            self.start_timer(hz)
        else:
            self.get_logger().error(
                f'publish_rate must be a positive number of Hz, not {hz}. Waiting for a better one.')
        self.add_on_set_parameters_callback(self.parameters_are_about_to_change)

    @staticmethod
    def is_rate(hz):
        return math.isfinite(hz) and hz > 0.0

    def start_timer(self, hz):
        if self.timer is not None:
            self.destroy_timer(self.timer)
        self.timer = self.create_timer(1.0 / hz, self.on_timer)

    def parameters_are_about_to_change(self, parameters):
        by_name = {parameter.name: parameter.value for parameter in parameters}
        hz = by_name.get('publish_rate')
        if hz is None:
            return SetParametersResult(successful=True)
        if not self.is_rate(hz):
            return SetParametersResult(successful=False, reason=f'{hz} Hz is not possible')
        self.start_timer(hz)
        return SetParametersResult(successful=True)

    def on_timer(self):
        if self.get_parameter('enabled').value is not True:
            return
        self.message.data = f"{self.get_parameter('message_prefix').value} ({self.number})"
        self.publisher.publish(self.message)
        self.number += 1


def main():
    stop = threading.Event()
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    node = ParameterizedPublisher()
    while not stop.is_set():
        rclpy.spin_once(node, timeout_sec=0.1)
    node.get_logger().info('interrupted')
    node.destroy_node()
    rclpy.shutdown()
    return 130


if __name__ == '__main__':
    sys.exit(main())
