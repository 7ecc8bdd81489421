import sys
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.publisher_ = self.create_publisher(String, 'chatter', 10)
        self.timer = None
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('enabled', True)
        rate = self.declare_parameter('publish_rate', 1.0).value
        if not rate > 0:
            self.get_logger().fatal(f'Invalid publish_rate {rate}')
            sys.exit(2)
        self.go(rate)
        self.publish()
        self.add_on_set_parameters_callback(self.cb)

    def go(self, rate):
        if self.timer is not None:
            self.timer.cancel()
            self.timer.destroy()
        self.timer = self.create_timer(1.0 / rate, self.publish)

    def cb(self, parameters):
        result = SetParametersResult(successful=True)
        rates = [p.value for p in parameters if p.name == 'publish_rate']
        if any(r <= 0 for r in rates):
            result.successful = False
            result.reason = 'publish_rate must be a positive number of messages per second'
        elif rates:
            self.go(rates[-1])
        return result

    def publish(self):
        if self.get_parameter('enabled').get_parameter_value().bool_value:
            msg = String()
            msg.data = self.get_parameter('message_prefix').get_parameter_value().string_value
            self.publisher_.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
