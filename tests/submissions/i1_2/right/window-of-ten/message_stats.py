import time
from collections import deque
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__("message_stats")
        self.recent = deque(maxlen=10)
        self.n_msgs, self.first, self.prev = 0, None, -1
        self.create_subscription(String, "chatter", self.listener_callback, 10)

    def listener_callback(self, msg):
        self.get_logger().info('I heard: "%s"' % msg.data)
        self.n_msgs += 1
        self.first = self.first or msg.data
        self.recent.append(time.time())
        seq = int("".join(c for c in msg.data if c.isdigit()))
        if self.prev >= 0:
            step = seq - self.prev
            if step > 1:
                self.get_logger().warn("missing messages %s" % list(range(self.prev + 1, seq)))
            elif step < 1:
                self.get_logger().warn("sequence went backwards, publisher restarted?")
        self.prev = seq
        if self.n_msgs % 10 == 0:
            rate = (len(self.recent) - 1) / (self.recent[-1] - self.recent[0])
            self.get_logger().info("%d messages so far (%.1f/s), from '%s' to '%s'" % (self.n_msgs, rate, self.first, msg.data))


def main():
    rclpy.init()
    node = Stats()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
