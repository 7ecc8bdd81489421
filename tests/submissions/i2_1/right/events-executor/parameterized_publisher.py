import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.count = 0
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)
        self.add_on_set_parameters_callback(self.check)

    def check(self, parameters):
        new = {parameter.name: parameter.value for parameter in parameters}
        rate = new.get('publish_rate')
        if rate is not None and rate <= 0:
            return SetParametersResult(successful=False, reason='publish_rate must be above 0')
        if rate is not None:
            self.destroy_timer(self.timer)
            self.timer = self.create_timer(1.0 / rate, self.tick)
        return SetParametersResult(successful=True)

    def tick(self):
        if self.get_parameter('enabled').value:
            self.publisher.publish(String(data=f"{self.get_parameter('message_prefix').value} {self.count}"))
            self.count += 1


def main():
    rclpy.init()
    executor = EventsExecutor()
    executor.add_node(ParameterizedPublisher())
    try:
        while rclpy.ok():
            executor.spin_once()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
