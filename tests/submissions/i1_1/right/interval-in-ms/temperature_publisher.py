import random
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64


class Sensor(Node):
    def __init__(self):
        super().__init__('sensor_node')
        self.interval_ms = self.declare_parameter('interval', 250).get_parameter_value().integer_value
        self.name = self.declare_parameter('name', 'sensor').get_parameter_value().string_value
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(self.interval_ms / 1000, self.cb)

    def cb(self):
        value = random.uniform(20.0, 30.0)
        msg = Float64()
        msg.data = value
        self.pub.publish(msg)
        self.get_logger().info(f'{self.name} published {value}')


def main():
    rclpy.init()
    sensor = Sensor()
    try:
        rclpy.spin(sensor)
    except KeyboardInterrupt:
        print('bye')
    except ExternalShutdownException:
        print('bye')
    sensor.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
