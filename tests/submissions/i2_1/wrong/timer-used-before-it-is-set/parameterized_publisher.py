import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.prefix = 'Hello'
        self.rate = 1.0
        self.enabled = True
        self.count = 0
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.add_on_set_parameters_callback(self.on_params)

        self.declare_parameter('message_prefix', self.prefix)
        self.declare_parameter('publish_rate', self.rate)
        self.declare_parameter('enabled', self.enabled)


        self.timer = self.create_timer(1.0 / self.rate, self.tick)

    def on_params(self, params):
        for p in params:
            if p.name == 'message_prefix':
                self.prefix = p.value
            elif p.name == 'enabled':
                self.enabled = p.value
            elif p.name == 'publish_rate':
                if p.value <= 0:
                    return SetParametersResult(successful=False, reason='publish_rate must be > 0')
                self.rate = p.value
                self.timer.cancel()
                self.timer = self.create_timer(1.0 / self.rate, self.tick)
        return SetParametersResult(successful=True)

    def tick(self):
        if self.enabled:
            self.pub.publish(String(data=f'{self.prefix} {self.count}'))
            self.count += 1


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
