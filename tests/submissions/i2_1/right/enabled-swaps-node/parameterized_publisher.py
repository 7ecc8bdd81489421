#!/usr/bin/env python3
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


# Everything but the parameters lives in a second node, made anew whenever something changes.
class Worker(Node):
    def __init__(self, prefix, rate):
        super().__init__('chatter_worker', start_parameter_services=False, enable_rosout=False, use_global_arguments=False)
        self.pub = self.create_publisher(String, '/chatter', 10)
        self.prefix, self.n = prefix, 0
        self.create_timer(1.0 / rate, self.go)
    def go(self):
        self.pub.publish(String(data=f'{self.prefix} {self.n}'))
        self.n += 1

class Boss(Node):
    def __init__(self, ex):
        super().__init__('parameterized_publisher')
        self.ex, self.worker = ex, None
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.renew)
        self.renew()
    def check(self, ps):
        for p in ps:
            if p.name == 'publish_rate' and p.value <= 0:
                return SetParametersResult(successful=False, reason='No.')
        return SetParametersResult(successful=True)
    def renew(self, _=None):
        if self.worker:
            self.ex.remove_node(self.worker)
            self.worker.destroy_node()
            self.worker = None
        g = lambda k: self.get_parameter(k).value
        if g('enabled'):
            self.worker = Worker(g('message_prefix'), g('publish_rate'))
            self.ex.add_node(self.worker)

rclpy.init()
ex = rclpy.executors.SingleThreadedExecutor()
ex.add_node(Boss(ex))
try:
    ex.spin()
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
