import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node('sprecher')
pub = node.create_publisher(String, 'gespraech', 10)
zahl = 0


def sprich():
    global zahl
    zahl += 1
    pub.publish(String(data=f'Guten Tag Nummer {zahl}'))


node.create_timer(0.4, sprich)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
