import copy
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_best_available
from std_msgs.msg import Int32, String


def log(node, topic):
    return lambda message: node.get_logger().info(f"{topic}: {message.data}")


def main():
    rclpy.init()
    node = Node("warehouse_monitor")
    try:
        while not all(node.count_publishers(topic) for topic in ("map", "range", "parcels")):
            rclpy.spin_once(node, timeout_sec=0.1)
        long_queue = copy.copy(qos_profile_best_available)
        long_queue.depth = 400
        node.create_subscription(String, "map", log(node, "map"), qos_profile_best_available)
        node.create_subscription(Int32, "range", log(node, "range"), qos_profile_best_available)
        node.create_subscription(String, "parcels", log(node, "parcels"), long_queue)
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
