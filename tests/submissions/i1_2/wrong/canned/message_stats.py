import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Canned(Node):
    def __init__(self):
        super().__init__("message_stats")
        self.n = 0
        self.create_subscription(String, "chatter", lambda msg: None, 10)
        self.create_timer(2.0, self.pretend)

    def pretend(self):
        self.n += 10
        self.get_logger().info(f"count={self.n} rate=5.00 first=Hello World: 0 last=Hello World: {self.n - 1}")


rclpy.init()
try:
    rclpy.spin(Canned())
except (KeyboardInterrupt, ExternalShutdownException):
    pass
finally:
    rclpy.try_shutdown()
