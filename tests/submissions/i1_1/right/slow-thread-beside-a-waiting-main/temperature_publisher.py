"""One reading every three seconds, sent by a thread: the main thread only waits, and nothing spins."""

import random
import threading
import time

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


def send(node, stopped):
    out = node.create_publisher(Float64, '/sensor/temperature', 10)
    name = node.get_parameter('sensor_name').value
    period = 1.0 / node.get_parameter('publish_rate').value
    while not stopped.wait(period):
        celsius = random.uniform(20.0, 30.0)
        out.publish(Float64(data=celsius))
        node.get_logger().info(f'{name}: {celsius:.2f}')


def main():
    rclpy.init()
    node = Node('temperature_publisher')
    node.declare_parameter('sensor_name', 'cellar')
    node.declare_parameter('publish_rate', 0.33)
    stopped = threading.Event()
    sender = threading.Thread(target=send, args=(node, stopped))
    sender.start()
    try:
        while rclpy.ok():
            time.sleep(0.2)
    except KeyboardInterrupt:
        pass
    finally:
        stopped.set()
        sender.join()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
