import time
import rclpy
from std_msgs.msg import Int32
rclpy.init()
n = rclpy.create_node('sub')
n.create_subscription(Int32, 'chatter', lambda m: n.get_logger().info(f'got {m.data}'), 10)
t = 0
try:
    while rclpy.ok():
        time.sleep(0.5)
        t += 1
        n.get_logger().info(f'still waiting, {t * 0.5} s')
except BaseException:
    pass
rclpy.try_shutdown()
