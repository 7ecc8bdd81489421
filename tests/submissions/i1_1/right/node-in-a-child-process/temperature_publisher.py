import multiprocessing
import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


def worker():
    rclpy.init()
    node = Node('temperature_publisher')
    name = node.declare_parameter('sensor_name', 'worker').value
    rate = node.declare_parameter('publish_rate', 2.0).value
    pub = node.create_publisher(Float64, '/sensor/temperature', 10)

    def tick():
        value = random.uniform(20.0, 30.0)
        pub.publish(Float64(data=value))
        node.get_logger().info(f'{name}: {value:.2f}')

    node.create_timer(1.0 / rate, tick)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    process = multiprocessing.Process(target=worker)
    process.start()
    try:
        process.join()
    except KeyboardInterrupt:
        process.join()
