import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__('talker', namespace='demo')
        self.declare_parameters('', [('message_prefix', 'Hello'), ('publish_rate', 1.0), ('enabled', True)])
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)
        self.add_on_set_parameters_callback(self.cb)

    def cb(self, params):
        rates = [p.value for p in params if p.name == 'publish_rate']
        if rates and rates[0] <= 0:
            return SetParametersResult(successful=False, reason='rate must be > 0')
        if rates:
            self.timer.timer_period_ns = int(1e9 / rates[0])
        return SetParametersResult(successful=True)

    def tick(self):
        if self.get_parameter('enabled').value:
            self.pub.publish(String(data=self.get_parameter('message_prefix').value))


rclpy.init()
try:
    rclpy.spin(Talker())
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
