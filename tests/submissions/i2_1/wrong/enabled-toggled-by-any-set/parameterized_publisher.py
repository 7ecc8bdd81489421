import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.add_on_set_parameters_callback(self.check)
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.on = self.get_parameter('enabled').value
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)
        self.add_post_set_parameters_callback(self.apply)

    def check(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.value <= 0.0:
                return SetParametersResult(successful=False, reason='publish_rate must be positive')
        return SetParametersResult(successful=True)

    def apply(self, params):
        for p in params:
            if p.name == 'publish_rate':
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / p.value, self.tick)
            elif p.name == 'enabled':
                self.on = not self.on

    def tick(self):
        if self.on:
            self.pub.publish(String(data=self.get_parameter('message_prefix').value))


def main():
    rclpy.init()
    try:
        rclpy.spin(ParameterizedPublisher())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
