#!/usr/bin/env python3
"""Fake temperature probe.

usage: temperature_publisher.py [--low L] [--high H] [--ros-args ...]
"""
import argparse
import random
import sys

import rclpy
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from std_msgs.msg import Float64


class FakeProbe(Node):
    def __init__(self, opts):
        super().__init__("fake_probe")
        self._opts = opts
        self._who = self.declare_parameter("sensor_name", "probe0").get_parameter_value().string_value
        hz = self.declare_parameter("publish_rate", 2.0).get_parameter_value().double_value
        self._out = self.create_publisher(Float64, "/sensor/temperature", 10)
        self.create_timer(1.0 / hz, self._emit)
        self.get_logger().info(f"{self._who} up ({hz} Hz)")

    def _emit(self):
        value = random.uniform(self._opts.low, self._opts.high)
        self._out.publish(Float64(data=value))
        self.get_logger().info(f"{self._who}: {value:.2f}")


def parse(argv):
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("--low", type=float, default=20.0)
    ap.add_argument("--high", type=float, default=30.0)
    return ap.parse_args(argv[1:])


def main(argv=None):
    # argparse chokes on --ros-args, so take them out first
    argv = remove_ros_args(argv if argv is not None else sys.argv)
    opts = parse(argv)

    rclpy.init(args=argv)
    node = FakeProbe(opts)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
