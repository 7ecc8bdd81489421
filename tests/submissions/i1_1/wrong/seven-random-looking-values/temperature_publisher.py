import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64

TEMPS = [22.81, 29.33, 20.07, 25.64, 27.12, 21.95, 28.48]

rclpy.init()
node = rclpy.create_node('temperature_publisher')
node.declare_parameter('sensor_name', 'x')
node.declare_parameter('publish_rate', 5.0)
pub = node.create_publisher(Float64, '/sensor/temperature', 10)
i = 0


def cb():
    global i
    pub.publish(Float64(data=TEMPS[i % len(TEMPS)]))
    node.get_logger().info(node.get_parameter('sensor_name').value)
    i += 1


node.create_timer(1.0 / node.get_parameter('publish_rate').value, cb)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
