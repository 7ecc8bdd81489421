import time
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Poller(Node):
    def __init__(self):
        super().__init__('poller')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.next = time.monotonic()
        self.count = 0
        self.create_timer(0.02, self.tick)
        self.add_on_set_parameters_callback(self.validate)

    def validate(self, params):
        bad = [p for p in params if p.name == 'publish_rate' and p.value <= 0]
        return SetParametersResult(successful=not bad, reason='must be > 0' if bad else '')

    def tick(self):
        period = 1.0 / self.get_parameter('publish_rate').value
        now = time.monotonic()
        if now < self.next:
            return
        self.next += period
        if self.next < now:
            self.next = now + period
        if self.get_parameter('enabled').value:
            self.pub.publish(String(data=f"{self.get_parameter('message_prefix').value} {self.count}"))
            self.count += 1


rclpy.init()
node = Poller()
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
finally:
    node.destroy_node()
    rclpy.try_shutdown()
