import random
import time

import rclpy
from std_msgs.msg import Float64


def main():
    rclpy.init()
    node = rclpy.create_node('temperature_publisher')
    node.declare_parameter('sensor_name', 'sensor')
    node.declare_parameter('publish_rate', 1.0)
    name = node.get_parameter('sensor_name').value
    rate = node.get_parameter('publish_rate').value
    pub = node.create_publisher(Float64, '/sensor/temperature', 10)
    try:
        while rclpy.ok():
            msg = Float64()
            msg.data = random.uniform(20, 30)
            pub.publish(msg)
            node.get_logger().info(f'{name}: {msg.data}')
            time.sleep(1.0 / rate)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
