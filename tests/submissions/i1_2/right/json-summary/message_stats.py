import json, re, time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Stats(Node):
    def __init__(self):
        super().__init__("stats")
        self.d = {"count": 0, "rate_hz": 0.0, "first": None, "last": None, "gaps": [], "restarts": 0}
        self.t0 = None
        self.prev = None
        self.create_subscription(String, "chatter", self.on, 10)

    def on(self, msg):
        d = self.d
        now = self.get_clock().now().nanoseconds / 1e9
        if self.t0 is None:
            self.t0 = now
            d["first"] = msg.data
        d["count"] += 1
        d["last"] = msg.data
        m = re.search(r"(\d+)\s*$", msg.data)
        if m:
            n = int(m.group(1))
            if self.prev is not None:
                if n < self.prev:
                    d["restarts"] += 1
                elif n > self.prev + 1:
                    d["gaps"].append({"from": self.prev, "to": n, "missing": n - self.prev - 1})
            self.prev = n
        if d["count"] % 10 == 0:
            d["rate_hz"] = d["count"] / (now - self.t0)
            self.get_logger().info(json.dumps(d))


rclpy.init()
try:
    rclpy.spin(Stats())
except (KeyboardInterrupt, ExternalShutdownException):
    pass
finally:
    rclpy.try_shutdown()
