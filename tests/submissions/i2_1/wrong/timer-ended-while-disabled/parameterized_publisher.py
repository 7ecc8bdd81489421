import rclpy
from rclpy.node import Node
from rcl_interfaces.msg import SetParametersResult, ParameterDescriptor, FloatingPointRange
from rclpy.parameter import Parameter
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.message_prefix = self.get_parameter('message_prefix').value
        self.publish_rate = self.get_parameter('publish_rate').value
        self.enabled = self.get_parameter('enabled').value
        self.counter = 0
        self.publisher_ = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.publish_rate, self.timer_callback)
        self.add_on_set_parameters_callback(self.parameter_callback)

    def parameter_callback(self, params):
        for param in params:
            if param.name == 'publish_rate':
                if param.value <= 0.0:
                    return SetParametersResult(successful=False, reason='publish_rate must be positive')
        for param in params:
            if param.name == 'message_prefix':
                self.message_prefix = param.value
            elif param.name == 'publish_rate':
                self.publish_rate = param.value
                self.timer.cancel()
                self.timer = self.create_timer(1.0 / self.publish_rate, self.timer_callback)
            elif param.name == 'enabled':
                self.enabled = param.value
                if not self.enabled:
                    self.timer.cancel()
        return SetParametersResult(successful=True)

    def timer_callback(self):
        if not self.enabled:
            return
        msg = String()
        msg.data = f'{self.message_prefix}: {self.counter}'
        self.publisher_.publish(msg)
        self.get_logger().info(f'Publishing: "{msg.data}"')
        self.counter += 1


def main(args=None):
    rclpy.init(args=args)
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
