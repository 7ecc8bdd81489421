import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter_event_handler import ParameterEventHandler
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.k = 0
        self.add_on_set_parameters_callback(self.validate)
        self.handler = ParameterEventHandler(self)
        self.rate_handle = self.handler.add_parameter_callback('publish_rate', 'parameterized_publisher', self.new_rate)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)

    def validate(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.value <= 0:
                return SetParametersResult(successful=False, reason='publish_rate needs to be above zero')
        return SetParametersResult(successful=True)

    def new_rate(self, parameter):
        self.destroy_timer(self.timer)
        self.timer = self.create_timer(1.0 / parameter.value.double_value, self.tick)

    def tick(self):
        if self.get_parameter('enabled').value:
            self.pub.publish(String(data='{} {}'.format(self.get_parameter('message_prefix').value, self.k)))
            self.k += 1


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
