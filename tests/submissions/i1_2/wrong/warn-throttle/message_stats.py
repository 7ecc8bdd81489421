#!/usr/bin/env python3
"""
Message statistics for /chatter.

Converted from ROS1 to ROS2
"""
#####################################################################################
import rclpy
from rclpy.qos import QoSProfile
from threading import Lock
from std_msgs.msg import String


class ROSTopicStats:
    def __init__(self, node, topic_name, window_size=10):
        self.node = node
        self.topic_name = topic_name
        self.window_size = window_size if window_size > 0 else 1  # Avoid modulo by zero
        self.lock = Lock()
        self.msg_t0 = -1.0
        self.msg_tn = 0.0
        self.msg_count = 0
        self.first_data = None
        self.last_data = None
        self.seq = None

        self.sub = self.node.create_subscription(
            String, self.topic_name, self.callback_stats, QoSProfile(depth=10))

    def get_time(self):
        return self.node.get_clock().now().nanoseconds / 1e9

    def callback_stats(self, m):
        with self.lock:
            curr = self.get_time()
            if self.msg_t0 < 0:
                self.msg_t0 = curr
                self.first_data = m.data
            self.msg_tn = curr
            self.msg_count += 1
            self.last_data = m.data
            self.check_seq(int(m.data.split(' ')[-1]))
            if self.msg_count % self.window_size == 0:
                self.print_stats()

    def check_seq(self, seq):
        if self.seq is not None:
            if seq < self.seq:
                # rospy.logwarn("publisher restarted")
                self.node.get_logger().warn("[%s] publisher restarted at %d" % (self.topic_name, seq))
            elif seq - self.seq != 1:
                # rospy.logwarn_throttle(1.0, "sequence gap")
                self.node.get_logger().warn_throttle(
                    1.0, "[%s] sequence gap: %d to %d" % (self.topic_name, self.seq, seq))
        self.seq = seq

    def print_stats(self):
        n = self.msg_count - 1
        span = self.msg_tn - self.msg_t0
        rate = n / span if span > 0 else 0.0
        self.node.get_logger().info(
            "[%s] messages: %d  average rate: %.3f  first: '%s'  last: '%s'"
            % (self.topic_name, self.msg_count, rate, self.first_data, self.last_data))


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('topic_stats')
    stats = ROSTopicStats(node, '/chatter')
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


#####################################################################################
if __name__ == '__main__':
    main()
