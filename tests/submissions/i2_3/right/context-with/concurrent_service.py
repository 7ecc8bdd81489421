import time

import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor

from slow_node import SlowNode


def main():
    rclpy.init()
    try:
        with MultiThreadedExecutor(num_threads=8) as executor:
            executor.add_node(SlowNode(work=lambda: time.sleep(3)))
            executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
