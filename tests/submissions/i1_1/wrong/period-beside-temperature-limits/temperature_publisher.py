import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperatureSensor(Node):
    def __init__(self):
        super().__init__('temperature_sensor')
        self.declare_parameters('', [
            ('publish_rate', 0.5),
            ('low', 20.0),
            ('high', 30.0),
            ('sensor_name', 'main_sensor'),
        ])
        self.low = self.get_parameter('low').value
        self.high = self.get_parameter('high').value
        self.sensor_name = self.get_parameter('sensor_name').value
        self.publisher = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(self.get_parameter('publish_rate').value, self.on_timer)

    def on_timer(self):
        msg = Float64(data=random.uniform(self.low, self.high))
        self.publisher.publish(msg)
        self.get_logger().info(f'{self.sensor_name}: {msg.data:.2f} °C')


def main(args=None):
    rclpy.init(args=args)
    node = TemperatureSensor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
