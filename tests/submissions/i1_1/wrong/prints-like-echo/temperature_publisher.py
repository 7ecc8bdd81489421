import random
import time
import rclpy

rclpy.init()
node = rclpy.create_node('temperature_publisher')
node.declare_parameter('sensor_name', 'x')
node.declare_parameter('publish_rate', 1.0)
try:
    while rclpy.ok():
        print('data:', random.uniform(20.0, 30.0))
        print('---')
        node.get_logger().info(node.get_parameter('sensor_name').value)
        time.sleep(1.0 / node.get_parameter('publish_rate').value)
except KeyboardInterrupt:
    pass
rclpy.try_shutdown()
