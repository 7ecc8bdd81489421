import time
import rclpy
from std_msgs.msg import String
rclpy.init()
n = rclpy.create_node('sub')
def got(m):
    time.sleep(4)
    print('verarbeitet', m.data, flush=True)
n.create_subscription(String, 'chatter', got, 1)
try:
    rclpy.spin(n)
except BaseException:
    pass
rclpy.try_shutdown()
