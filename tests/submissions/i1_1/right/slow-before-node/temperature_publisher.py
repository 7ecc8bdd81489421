import random
import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64

print('warming up the sensor...')
time.sleep(2)


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.name = self.declare_parameter('sensor_name', 'slow').value
        rate = self.declare_parameter('publish_rate', 2.0).value
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / rate, self.tick)

    def tick(self):
        msg = Float64(data=random.uniform(20.0, 30.0))
        self.pub.publish(msg)
        self.get_logger().info(f'{self.name}: {msg.data}')


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
