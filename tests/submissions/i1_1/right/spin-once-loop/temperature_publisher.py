import random
import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


def run():
    rclpy.init()
    node = Node('temp_loop')
    node.declare_parameter('frequency', 5.0)
    node.declare_parameter('sensor_name', 'loop')
    pub = node.create_publisher(Float64, '/sensor/temperature', 10)
    nxt = time.monotonic()
    while rclpy.ok():
        now = time.monotonic()
        if now >= nxt:
            value = random.uniform(20.0, 30.0)
            pub.publish(Float64(data=value))
            node.get_logger().info(node.get_parameter('sensor_name').value + f': {value:.3f}')
            nxt += 1.0 / node.get_parameter('frequency').value
        rclpy.spin_once(node, timeout_sec=max(0.0, nxt - time.monotonic()))


try:
    run()
except (KeyboardInterrupt, ExternalShutdownException):
    pass
finally:
    rclpy.try_shutdown()
