import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor


def run(make_node):
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(make_node())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
