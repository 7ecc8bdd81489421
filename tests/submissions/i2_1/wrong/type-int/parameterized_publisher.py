import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Int32


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameters('', [('message_prefix', 'Hello'), ('publish_rate', 1.0), ('enabled', True)])
        self.pub = self.create_publisher(Int32, 'chatter', 10)
        self.n = 0
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)
        self.add_on_set_parameters_callback(self.cb)

    def cb(self, params):
        for p in params:
            if p.name == 'publish_rate':
                if p.value <= 0:
                    return SetParametersResult(successful=False, reason='rate must be > 0')
                self.timer.timer_period_ns = int(1e9 / p.value)
        return SetParametersResult(successful=True)

    def tick(self):
        if self.get_parameter('enabled').value:
            self.n += 1
            self.pub.publish(Int32(data=self.n))
            self.get_logger().info(self.get_parameter('message_prefix').value + str(self.n))


rclpy.init()
try:
    rclpy.spin(ParameterizedPublisher())
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
