import json, sys, time, rclpy
from rclpy.node import Node
from std_msgs.msg import String
# count /chatter, one log line per 10 samples
class Counter(Node):
    def __init__(self):
        super().__init__("chatter_counter")
        self.chatter = 0; self.first = None; self.last = None
        self.t = None; self.n = None
        self.create_subscription(String, "/chatter", self.on_chatter, 10)
    def on_chatter(self, m):
        if self.t is None: self.t = time.time(); self.first = m.data
        self.chatter += 1; self.last = m.data
        n = int(m.data.split(": ")[1])
        if self.n is not None:
            if n < self.n: self.get_logger().warn("publisher restart, count goes on")
            missing = list(range(self.n, n))
            if missing: self.get_logger().warn(f"missing: {json.dumps(missing)}")
        self.n = n
        if self.chatter % 10 == 0: self.report()
    def report(self):
        rate = self.chatter / (time.time() - self.t)
        self.get_logger().info(f"total {self.chatter}, "
                               "rate {rate:.2f} msg/s, "
                               f"first '{self.first}', last '{self.last}'")
rclpy.init(args=sys.argv); node = Counter()
try:
    while rclpy.ok(): rclpy.spin_once(node, timeout_sec=1.0)
except KeyboardInterrupt: pass
node.destroy_node(); rclpy.try_shutdown()
