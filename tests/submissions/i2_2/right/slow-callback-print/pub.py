import rclpy
from rclpy.node import Node
from rclpy.qos import *
from rclpy.duration import Duration
from std_msgs.msg import String
rclpy.init()
n = Node('pub')
p = n.create_publisher(String, 'chatter', 10)
i = 0
def go():
    global i
    i += 1
    pass
    p.publish(String(data=f'hi {i}'))
n.create_timer(0.5, go)
try:
    rclpy.spin(n)
except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
    pass
rclpy.try_shutdown()
