import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('publisher', namespace='sensor')
        self.declare_parameter('sensor_name', 'ns')
        self.declare_parameter('rate', 3.0)
        self.pub = self.create_publisher(Float64, 'temperature', 10)
        self.create_timer(1.0 / self.get_parameter('rate').value, self.tick)

    def tick(self):
        msg = Float64(data=random.uniform(20.0, 30.0))
        self.pub.publish(msg)
        self.get_logger().info('{}: {:.2f}'.format(self.get_parameter('sensor_name').value, msg.data))


if __name__ == '__main__':
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
