import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.rate = self.get_parameter('publish_rate').value
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.tick)
        self.add_post_set_parameters_callback(self.changed)

    def changed(self, params):
        for p in params:
            if p.name != 'publish_rate' or p.value == self.rate:
                continue
            if p.value <= 0:
                self.get_logger().error('invalid publish_rate, going back to the old one')
                self.set_parameters([Parameter('publish_rate', value=self.rate)])
                continue
            self.rate = p.value
            self.destroy_timer(self.timer)
            self.timer = self.create_timer(1.0 / self.rate, self.tick)

    def tick(self):
        if self.get_parameter('enabled').value:
            self.pub.publish(String(data=self.get_parameter('message_prefix').value))


def main():
    rclpy.init()
    try:
        rclpy.spin(ParameterizedPublisher())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
