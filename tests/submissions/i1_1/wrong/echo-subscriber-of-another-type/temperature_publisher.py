#!/usr/bin/env python3
# Temperature publisher + small display.
# The display runs in a process of its own so that the GIL doesn't disturb the timer.
import multiprocessing
import random
import time

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64, String

TOPIC = '/sensor/temperature'


class Display(Node):
    """Draws a bar for each reading (text for now, the OLED comes later)."""

    def __init__(self):
        super().__init__('temperature_display')
        self.last = None
        # from the String version of minimal_subscriber
        self.subscription = self.create_subscription(String, TOPIC, self.listener_callback, 10)

    def listener_callback(self, msg):
        try:
            self.last = float(msg.data)
        except ValueError:
            return
        bar = '#' * int(self.last - 20.0)
        print(f'{self.last:5.1f} |{bar}', flush=True)


def run_display():
    rclpy.init()
    display = Display()
    try:
        rclpy.spin(display)
    except BaseException:
        pass


class TemperaturePublisher(Node):

    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'display_sensor')
        self.name_in_log = self.get_parameter('sensor_name').value

        self.publisher_ = self.create_publisher(Float64, TOPIC, 10)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.timer_callback)
        self.t0 = time.time()

    def timer_callback(self):
        msg = Float64()
        msg.data = random.uniform(20.0, 30.0)
        self.publisher_.publish(msg)
        self.get_logger().info(f'{self.name_in_log} {time.time() - self.t0:.1f}s: {msg.data:.2f}')


def main(args=None):
    display = multiprocessing.Process(target=run_display, daemon=True)
    display.start()      # before rclpy.init(), a forked context does not work

    rclpy.init(args=args)
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
        display.terminate()
        display.join(2.0)


if __name__ == '__main__':
    main()
