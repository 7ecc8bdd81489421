import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Chatter(Node):
    def __init__(self):
        super().__init__('chatter')
        self.declare_parameters('', [('message_prefix', 'Hello'), ('publish_rate', 1.0), ('enabled', True)])
        self.pub = self.create_publisher(String, 'chatter', 10)
        rate = self.get_parameter('publish_rate').value
        self.timer = self.create_timer(1.0 / rate, self.tick)
        self.add_on_set_parameters_callback(self.cb)

    def cb(self, params):
        ok = not any(p.name == 'publish_rate' and p.value <= 0 for p in params)
        if ok:
            for p in params:
                if p.name == 'publish_rate':
                    self.timer.timer_period_ns = int(1e9 / p.value)
                    self.timer.reset()
        return SetParametersResult(successful=ok, reason=' ')

    def tick(self):
        if self.get_parameter('enabled').value:
            self.pub.publish(String(data=self.get_parameter('message_prefix').value))


rclpy.init()
try:
    rclpy.spin(Chatter())
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
