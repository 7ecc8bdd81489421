#!/usr/bin/env python3
import rclpy
import rclpy.time
from rclpy.duration import Duration
from rclpy.node import Node
from std_msgs.msg import String


class SpeedStats(Node):
    """Counts /chatter and measures how fast it comes."""

    def __init__(self):
        super().__init__('message_stats')
        self.sub = self.create_subscription(String, '/chatter', self.callback, 10)

        self.total_count = 0
        self.session_count = 0       # since the publisher was (re)started
        self.session_start = None
        self.first_message = ""
        self.last_message = ""
        self.prev = None

    def callback(self, msg):
        num = int(msg.data.split(": ")[-1])

        if self.session_start is None:
            self.session_start = self.get_clock().now()
            self.first_message = msg.data

        if self.prev is not None:
            if num < self.prev:
                self.on_restart(num)
            elif num > self.prev + 1:
                self.get_logger().warn(f"Missed {num - self.prev - 1} messages ({self.prev} -> {num})")
        self.prev = num

        self.total_count += 1
        self.session_count += 1
        self.last_message = msg.data

        if self.total_count % 10 == 0:
            self.log_stats()

    def on_restart(self, num):
        self.get_logger().info(f"Publisher restarted at {num}, total stays at {self.total_count}")
        # measure the rate anew, the pause would spoil it
        self.session_count = 0
        self.session_start = rclpy.time.Time.now()

    def log_stats(self):
        elapsed = self.get_clock().now() - self.session_start
        if elapsed > Duration(seconds=0):
            rate = self.session_count / (elapsed.nanoseconds / 1e9)
        else:
            rate = 0.0
        self.get_logger().info(
            f"Total: {self.total_count}, Rate: {rate:.2f} msg/s, "
            f"First: {self.first_message}, Last: {self.last_message}"
        )


def main():
    rclpy.init()
    speed_stats = SpeedStats()
    try:
        rclpy.spin(speed_stats)
    except KeyboardInterrupt:
        pass
    finally:
        speed_stats.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
