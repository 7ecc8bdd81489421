#!/usr/bin/env python3
import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64



class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.rate = self.declare_parameter('publish_rate', 1.0).value
        self.sensor = self.declare_parameter('sensor_name', 'temp').value
        self.n = 0
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)

    def timer_callback(self):
        self.n += 1
        v = 85.0 if self.n % 8 == 0 else random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=float(v)))
        self.get_logger().info(f'{self.sensor}: {v:.2f}')



def main(args=None):
    rclpy.init(args=args)
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
