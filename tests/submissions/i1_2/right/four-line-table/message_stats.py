#!/usr/bin/env python3
import re

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import String

NUMBER = re.compile(r'(\d+)\s*$')


class TopicStats:
    def __init__(self):
        self.count = 0
        self.missing = 0
        self.first = None
        self.last = None
        self.report_ns = None      # where the present window begins
        self.report_count = 0
        self.number = None


class TopicRateLogger(Node):
    def __init__(self):
        super().__init__("topic_rate_logger")

        self.declare_parameter("topic", "/chatter")
        self.declare_parameter("report_every", 10)
        topic = self.get_parameter("topic").get_parameter_value().string_value
        self.every = self.get_parameter("report_every").get_parameter_value().integer_value

        self.stats = {topic: TopicStats()}
        # could be more topics later, so the callback gets its topic bound
        for name in self.stats:
            self.create_subscription(
                String, name, lambda msg, name=name: self.cb(name, msg), QoSProfile(depth=20))
        self.get_logger().info("logging rates of: " + ", ".join(self.stats))

    def cb(self, topic, msg):
        s = self.stats[topic]
        now = self.get_clock().now().nanoseconds

        s.count += 1
        if s.count == 1:
            s.first = msg.data
            s.report_ns = now
            s.report_count = 1     # the window starts with this one, it is not in it
        s.last = msg.data
        self.track(s, msg.data)

        if s.count % self.every == 0:
            self.report(topic, s, now)

    def track(self, s, text):
        m = NUMBER.search(text)
        if m is None:
            return
        n = int(m.group(1))
        if s.number is not None:
            step = n - s.number
            if step > 1:
                s.missing += step - 1
            elif step < 1:
                self.get_logger().info("numbers begin again at %d, the publisher was restarted" % n)
        s.number = n

    def report(self, topic, s, now):
        seconds = (now - s.report_ns) / 1e9
        rate = (s.count - s.report_count) / seconds if seconds > 0 else 0.0
        s.report_ns = now
        s.report_count = s.count

        log = self.get_logger()
        log.info("%s: total %d, missing %d" % (topic, s.count, s.missing))
        log.info("    rate  %.2f msg/s" % rate)
        log.info("    first \"%s\"" % s.first)
        log.info("    last  \"%s\"" % s.last)


def main(args=None):
    rclpy.init(args=args)
    node = TopicRateLogger()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
