import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Beacon(Node):
    def __init__(self):
        super().__init__('beacon')
        self.prefix = self.declare_parameter('message_prefix', 'Hello').value
        self.rate = self.declare_parameter('publish_rate', 1.0).value
        self.enabled = self.declare_parameter('enabled', True).value
        if self.rate <= 0.0:
            raise SystemExit(f'publish_rate must be positive, not {self.rate}')
        self.count = 0
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.flash)
        if not self.enabled:
            self.timer.cancel()
        self.add_on_set_parameters_callback(self.validate)
        self.add_post_set_parameters_callback(self.apply)

    def flash(self):
        self.publisher.publish(String(data=f'{self.prefix} {self.count}'))
        self.count += 1

    def validate(self, parameters):
        for parameter in parameters:
            if parameter.name == 'publish_rate' and parameter.value <= 0.0:
                return SetParametersResult(successful=False, reason='publish_rate must be positive')
        return SetParametersResult(successful=True)

    def apply(self, parameters):
        for parameter in parameters:
            match parameter.name:
                case 'message_prefix':
                    self.prefix = parameter.value
                case 'enabled' if parameter.value:
                    self.timer.reset()
                case 'enabled':
                    self.timer.cancel()
                case 'publish_rate':
                    self.timer.timer_period_ns = int(1e9 / parameter.value)
                    if not self.timer.is_canceled():
                        self.timer.reset()


def main():
    rclpy.init()
    node = Beacon()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
