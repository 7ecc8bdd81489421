import random

import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Float64


class Temp(Node):
    def __init__(self):
        super().__init__('temp')
        self.declare_parameters('', [('hz', 5.0), ('sensor_id', 'S-0')])
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.create_timer(1.0 / self.get_parameter('hz').value, self.on_timer)

    async def on_timer(self):
        temp = random.uniform(20.0, 30.0)
        self.pub.publish(Float64(data=temp))
        self.get_logger().info(f"{self.get_parameter('sensor_id').value}: {temp}")


def main():
    rclpy.init()
    node = Temp()
    executor = MultiThreadedExecutor(2)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
