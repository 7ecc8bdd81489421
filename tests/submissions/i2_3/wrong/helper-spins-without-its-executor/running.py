"""How our nodes are run."""

import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor


def run_threaded(make_node, threads):
    rclpy.init()
    node = make_node()
    pool = MultiThreadedExecutor(num_threads=threads)
    pool.add_node(node)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
