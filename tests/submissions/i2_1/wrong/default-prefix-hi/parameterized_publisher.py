import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.prefix = self.declare_parameter('message_prefix', 'Hi').value
        self.rate = self.declare_parameter('publish_rate', 1.0).value
        self.enabled = self.declare_parameter('enabled', True).value
        if self.rate <= 0:
            self.get_logger().error('publish_rate is not positive, I take 1.0')
            self.rate = 1.0
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.tick)
        self.add_on_set_parameters_callback(self.cb)

    def cb(self, params):
        d = {p.name: p.value for p in params}
        if d.get('publish_rate', 1.0) <= 0:
            return SetParametersResult(successful=False, reason='publish_rate is not positive')
        self.prefix = d.get('message_prefix', self.prefix)
        self.enabled = d.get('enabled', self.enabled)
        if 'publish_rate' in d:
            self.timer.cancel()
            self.timer = self.create_timer(1.0 / d['publish_rate'], self.tick)
        return SetParametersResult(successful=True)

    def tick(self):
        if self.enabled:
            self.pub.publish(String(data=self.prefix + ' world'))


rclpy.init()
try:
    rclpy.spin(ParameterizedPublisher())
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
