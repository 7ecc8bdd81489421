import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.group = ReentrantCallbackGroup()
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.count = 0
        self.timer = self.new_timer(self.get_parameter('publish_rate').value)
        self.add_on_set_parameters_callback(self.only_positive)
        self.add_on_set_parameters_callback(self.not_too_fast)
        self.add_post_set_parameters_callback(self.use)

    def new_timer(self, rate):
        return self.create_timer(1.0 / rate, self.tick, callback_group=self.group)

    def only_positive(self, params):
        ok = all(p.value > 0 for p in params if p.name == 'publish_rate')
        return SetParametersResult(successful=ok, reason='' if ok else 'publish_rate must be positive')

    def not_too_fast(self, params):
        ok = all(p.value <= 1000 for p in params if p.name == 'publish_rate')
        return SetParametersResult(successful=ok, reason='' if ok else 'publish_rate is limited to 1 kHz')

    def use(self, params):
        for p in params:
            if p.name == 'publish_rate':
                old, self.timer = self.timer, self.new_timer(p.value)
                self.destroy_timer(old)

    async def tick(self):
        if self.get_parameter('enabled').value:
            self.pub.publish(String(data=self.get_parameter('message_prefix').value + f'! ({self.count})'))
            self.count += 1


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=3)
    node = ParameterizedPublisher()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
