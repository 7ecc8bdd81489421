import random
import threading

import rclpy
from rclpy.exceptions import ROSInterruptException
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64


def spin(node):
    try:
        rclpy.spin(node)
    except ExternalShutdownException:
        pass


def main():
    rclpy.init()
    node = rclpy.create_node('temperature')
    pub = node.create_publisher(Float64, '/sensor/temperature', 10)
    name = node.declare_parameter('sensor_name', 'attic').value
    rate = node.create_rate(node.declare_parameter('publish_rate', 2.0).value)
    thread = threading.Thread(target=spin, args=(node,), daemon=True)
    thread.start()
    try:
        while rclpy.ok():
            value = random.uniform(20.0, 30.0)
            pub.publish(Float64(data=value))
            node.get_logger().info(f'{name}: {value:.2f}')
            rate.sleep()
    except (KeyboardInterrupt, ROSInterruptException):
        pass
    rclpy.try_shutdown()
    thread.join(1.0)


if __name__ == '__main__':
    main()
