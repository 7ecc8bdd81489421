import time
import rclpy
from std_msgs.msg import String
rclpy.init()
n = rclpy.create_node('sub', start_parameter_services=True)
s = n.create_subscription(String, 'chatter', lambda m: None, 10)
try:
    while rclpy.ok():
        with s.handle:
            got = s.handle.take_message(String, False)
        if got:
            n.get_logger().info('polled: ' + got[0].data.upper())
        time.sleep(0.1)
except BaseException:
    pass
rclpy.try_shutdown()
