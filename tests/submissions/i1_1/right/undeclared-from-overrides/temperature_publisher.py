import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher', automatically_declare_parameters_from_overrides=True)
        self.sensor = self.get_parameter_or('sensor_name', Parameter('sensor_name', value='default')).value
        rate = self.get_parameter_or('publish_rate', Parameter('publish_rate', value=2.0)).value
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / rate, self.tick)

    def tick(self):
        msg = Float64(data=random.uniform(20.0, 30.0))
        self.pub.publish(msg)
        self.get_logger().info(f'{self.sensor}: {msg.data:.2f}')


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
