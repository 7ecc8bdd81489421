import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Pub(Node):
    def __init__(self):
        super().__init__('param_pub')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('enabled', True)
        self.n = 0
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0, self.tick)
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.apply)
        # declared last: both callbacks see the value given at start-up
        try:
            self.declare_parameter('publish_rate', 1.0)
        except rclpy.exceptions.InvalidParameterValueException as e:
            self.get_logger().error(f'bad publish_rate: {e}')
            self.declare_parameter('publish_rate', 1.0, ignore_override=True)

    def check(self, params):
        for p in params:
            if p.name == 'publish_rate' and not p.value > 0:
                return SetParametersResult(successful=False, reason='rate has to be positive')
        return SetParametersResult(successful=True)

    def apply(self, params):
        for p in params:
            if p.name == 'publish_rate':
                self.timer.timer_period_ns = int(1e9 / p.value)
                self.timer.reset()

    def tick(self):
        if not self.get_parameter('enabled').value:
            return
        prefix = self.get_parameter('message_prefix').value
        self.pub.publish(String(data=f'{prefix} world {self.n}'))
        self.n += 1


def main():
    rclpy.init()
    node = Pub()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
