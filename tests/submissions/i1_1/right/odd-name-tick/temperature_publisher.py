import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64

class Tick(Node):
    def __init__(self):
        super().__init__('tick')
        tick = self.declare_parameter('tick', 1.0).value
        self.where = self.declare_parameter('location', 'cellar').value
        self.p = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.t = self.create_timer(tick, self.on_tick)

    def on_tick(self):
        x = round(random.uniform(20.0, 30.0), 1)
        self.p.publish(Float64(data=x))
        self.get_logger().info(f'It is {x} degrees in the {self.where}.')

if __name__ == '__main__':
    rclpy.init()
    node = Tick()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
