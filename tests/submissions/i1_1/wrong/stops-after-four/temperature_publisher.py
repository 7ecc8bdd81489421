import random
import time
import rclpy
from std_msgs.msg import Float64

rclpy.init()
node = rclpy.create_node('temperature_publisher')
node.declare_parameter('sensor_name', 'x')
node.declare_parameter('publish_rate', 5.0)
pub = node.create_publisher(Float64, '/sensor/temperature', 10)
for i in range(4):
    pub.publish(Float64(data=random.uniform(20.0, 30.0)))
    node.get_logger().info(node.get_parameter('sensor_name').value)
    time.sleep(1.0 / node.get_parameter('publish_rate').value)
rclpy.shutdown()
