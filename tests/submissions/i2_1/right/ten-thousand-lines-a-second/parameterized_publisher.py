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
        self.add_on_set_parameters_callback(self.validate)
        self.add_post_set_parameters_callback(self.apply)
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.count = 0
        self.steps = 0
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)
        self.create_timer(0.01, self.trace)

    def validate(self, params):
        for p in params:
            if p.name == 'publish_rate' and not p.value > 0.0:
                return SetParametersResult(successful=False, reason='publish_rate must be positive')
        return SetParametersResult(successful=True)

    def apply(self, params):
        for p in params:
            if p.name == 'publish_rate':
                self.timer.cancel()
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / p.value, self.tick)

    def trace(self):
        for _ in range(100):
            self.steps += 1
            print(f'debug: step {self.steps}, {self.count} messages so far')

    def tick(self):
        if not self.get_parameter('enabled').value:
            return
        msg = String()
        msg.data = f"{self.get_parameter('message_prefix').value} #{self.count}"
        self.pub.publish(msg)
        self.count += 1


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
