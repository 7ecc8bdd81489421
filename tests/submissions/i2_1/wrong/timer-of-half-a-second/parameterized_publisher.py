import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):

    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        rate = self.declare_parameter('publish_rate', 1.0).value
        if rate <= 0.0:
            self.get_logger().error(f'publish_rate must be greater than 0, not {rate}')
        self.declare_parameter('enabled', True)
        self.add_on_set_parameters_callback(self.check)
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(0.5, self.tick)
        self.n = 0

    def check(self, params):
        for param in params:
            if param.name == 'publish_rate' and param.value <= 0.0:
                return SetParametersResult(successful=False, reason='publish_rate must be greater than 0')
        return SetParametersResult(successful=True)

    def tick(self):
        if self.get_parameter('enabled').value:
            self.pub.publish(String(data=f"{self.get_parameter('message_prefix').value} World: {self.n}"))
            self.n += 1


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
