import os
import random
import time
import rclpy
from std_msgs.msg import Float64

rclpy.init()
node = rclpy.create_node('temperature_publisher')
node.declare_parameter('sensor_name', 'x')
node.declare_parameter('publish_rate', 1.0)
pub = node.create_publisher(Float64, '/sensor/temperature', 10)
while pub.get_subscription_count() == 0:
    time.sleep(0.01)
node.get_logger().info(node.get_parameter('sensor_name').value)
pub.publish(Float64(data=random.uniform(20.0, 30.0)))
time.sleep(0.2)
os._exit(0)
