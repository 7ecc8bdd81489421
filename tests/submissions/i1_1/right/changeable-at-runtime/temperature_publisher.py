import random
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'garage')
        self.declare_parameter('publish_rate', 1.0)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = None
        self.start_timer(self.get_parameter('publish_rate').value)
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.apply)

    def start_timer(self, rate):
        if self.timer is not None:
            self.destroy_timer(self.timer)
        self.timer = self.create_timer(1.0 / rate, self.tick)

    def check(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.value <= 0:
                return SetParametersResult(successful=False, reason='must be > 0')
        return SetParametersResult(successful=True)

    def apply(self, params):
        for p in params:
            if p.name == 'publish_rate':
                self.start_timer(p.value)

    def tick(self):
        msg = Float64(data=random.uniform(20.0, 30.0))
        self.pub.publish(msg)
        self.get_logger().info(f"{self.get_parameter('sensor_name').value}: {msg.data:.2f}")


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
