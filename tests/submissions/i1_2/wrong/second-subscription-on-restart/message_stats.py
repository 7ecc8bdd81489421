#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from std_msgs.msg import String
from time import time

TOPIC = "/chatter"


class ChatterLink(Node):
    """Same idea as our serial link class: connect(), on_data(), reconnect on trouble"""

    def __init__(self):
        super().__init__("chatter_link")
        self.rx = 0
        self.rx_start = 0
        self.first_line = ""
        self.last_line = ""
        self.last_id = -1
        self.reconnects = 0
        self.connect()

    def connect(self):
        self.link = self.create_subscription(String, TOPIC, self.on_data, 10)
        self.get_logger().info("connected to " + TOPIC)

    def on_data(self, msg):
        if self.rx == 0:
            self.rx_start = time()
            self.first_line = msg.data
        self.rx += 1
        self.last_line = msg.data

        msg_id = int(msg.data.split(": ")[1])
        if self.last_id >= 0:
            if msg_id < self.last_id:
                # other side was rebooted, get a fresh link
                self.reconnects += 1
                self.get_logger().warn("publisher restarted, reconnecting (#%d)" % self.reconnects)
                self.connect()
            elif msg_id > self.last_id + 1:
                self.get_logger().warn("gap: lost %d messages after id %d" % (msg_id - self.last_id - 1, self.last_id))
        self.last_id = msg_id

        if self.rx % 10 == 0:
            dt = time() - self.rx_start
            self.get_logger().info("rx=%d rate=%.2f msg/s first='%s' last='%s'" % (
                self.rx, self.rx / max(dt, 0.001), self.first_line, self.last_line))


def main():
    rclpy.init()
    link = ChatterLink()
    try:
        rclpy.spin(link)
    except KeyboardInterrupt:
        print("bye")


if __name__ == "__main__":
    main()
