import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.prefix = self.declare_parameter('message_prefix', 'Hello').value
        rate = self.declare_parameter('publish_rate', 1.0).value
        self.on = self.declare_parameter('enabled', True).value
        self.counter = 0
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / rate, self.send, autostart=self.on)
        self.add_on_set_parameters_callback(self.set_cb)

    def set_cb(self, params):
        new = {p.name: p.value for p in params}
        if new.get('publish_rate', 1.0) <= 0:
            return SetParametersResult(successful=False, reason='publish_rate: only numbers above 0')
        self.prefix = new.get('message_prefix', self.prefix)
        self.on = new.get('enabled', self.on)
        if 'publish_rate' in new:
            self.timer.timer_period_ns = int(1e9 / new['publish_rate'])
        if self.on:
            self.timer.reset()
        else:
            self.timer.cancel()
        return SetParametersResult(successful=True)

    def send(self):
        self.pub.publish(String(data=f'{self.prefix} number {self.counter}'))
        self.counter += 1


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
