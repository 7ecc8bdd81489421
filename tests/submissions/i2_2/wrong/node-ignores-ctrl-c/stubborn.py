import signal
import time

import rclpy
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import String


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    node = rclpy.create_node('stubborn')
    pub = node.create_publisher(String, 'chatter', 10)
    while True:
        pub.publish(String(data='still here'))
        rclpy.spin_once(node, timeout_sec=0.5)
        time.sleep(0.1)
