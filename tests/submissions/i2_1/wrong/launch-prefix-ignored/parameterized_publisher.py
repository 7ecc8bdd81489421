import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.prefix = 'Hello'
        self.rate = self.get_parameter('publish_rate').value
        self.enabled = self.get_parameter('enabled').value
        if self.rate <= 0:
            raise SystemExit('publish_rate must be > 0')
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.tick)
        self.add_on_set_parameters_callback(self.cb)

    def cb(self, params):
        if any(p.name == 'publish_rate' and p.value <= 0 for p in params):
            return SetParametersResult(successful=False, reason='publish_rate must be > 0')
        for p in params:
            if p.name == 'message_prefix':
                self.prefix = p.value
            if p.name == 'enabled':
                self.enabled = p.value
            if p.name == 'publish_rate':
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / p.value, self.tick)
        return SetParametersResult(successful=True)

    def tick(self):
        if self.enabled:
            self.pub.publish(String(data=self.prefix))


def main():
    rclpy.init()
    try:
        rclpy.spin(ParameterizedPublisher())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
