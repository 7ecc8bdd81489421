import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.i = 0
        self.timer = self.create_timer(1.0, self.send)

        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        if self.get_parameter('publish_rate').value <= 0.0:
            raise ValueError('publish_rate must be greater than 0')
        self.rate_timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.send)
        self.add_on_set_parameters_callback(self.on_change)

    def on_change(self, params):
        for p in params:
            if p.name == 'publish_rate' and not p.value > 0.0:
                return SetParametersResult(successful=False, reason='publish_rate must be greater than 0')
        for p in params:
            if p.name == 'publish_rate':
                self.rate_timer.cancel()
                self.rate_timer = self.create_timer(1.0 / p.value, self.send)
        return SetParametersResult(successful=True)

    def send(self):
        if self.get_parameter('enabled').value:
            text = f"{self.get_parameter('message_prefix').value} {self.i}"
            self.pub.publish(String(data=text))
            self.i += 1


def main():
    rclpy.init()
    try:
        rclpy.spin(ParameterizedPublisher())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
