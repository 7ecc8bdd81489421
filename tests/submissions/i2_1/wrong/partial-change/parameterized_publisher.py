import sys
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.prefix = self.declare_parameter('message_prefix', 'Hello').value
        self.rate = self.declare_parameter('publish_rate', 1.0).value
        self.enabled = self.declare_parameter('enabled', True).value
        if self.rate <= 0:
            self.get_logger().fatal('publish_rate must be greater than 0')
            sys.exit(1)
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.tick)
        self.add_on_set_parameters_callback(self.cb)

    def cb(self, params):
        for p in params:
            if p.name == 'message_prefix':
                self.prefix = p.value
            elif p.name == 'enabled':
                self.enabled = p.value
            elif p.name == 'publish_rate':
                if p.value <= 0:
                    return SetParametersResult(successful=False, reason='publish_rate must be greater than 0')
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
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
