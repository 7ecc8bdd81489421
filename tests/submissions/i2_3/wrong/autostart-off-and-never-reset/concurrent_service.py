import time

import rclpy
from rclpy.node import Node
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from example_interfaces.srv import AddTwoInts


class Color:
    GREEN = "\033[92m"
    YELLOW = "\033[93m"
    END = "\033[0m"


class ConcurrentServiceInterface(Node):
    """Interface class for the concurrency exercise.

    Attributes:
        _service: server for /slow_add
        _fast_timer: 10 Hz timer
        _count: number of ticks so far
    """

    def __init__(self, node_name="concurrent_service"):
        super().__init__(node_name)

        # Callback groups
        self._service_cb_group = MutuallyExclusiveCallbackGroup()
        self._timer_cb_group = ReentrantCallbackGroup()

        self._count = 0

        # Not before everything is in place
        self._fast_timer = self.create_timer(
            0.1,
            self._fast_timer_cb,
            callback_group=self._timer_cb_group,
            autostart=False,
        )

        self._service = self.create_service(
            AddTwoInts,
            "slow_add",
            self._slow_add_cb,
            callback_group=self._service_cb_group,
        )

        self._log(Color.GREEN, f"{node_name} is up, service and timer are ready")

    def _log(self, color, text):
        self.get_logger().info(f"{color}{text}{Color.END}")

    def _fast_timer_cb(self):
        """Callback of the fast timer."""
        self._count += 1
        if self._count % 10 == 0:
            self._log(Color.YELLOW, f"Fast timer: {self._count}")

    def _slow_add_cb(self, request, response):
        """Callback of the service, takes 3 s.

        Args:
            request: operands a and b
            response: sum

        Returns:
            response with the sum filled in
        """
        self._log(Color.GREEN, f"Received: {request.a}, {request.b}")
        time.sleep(3.0)
        response.sum = request.a + request.b
        self._log(Color.GREEN, f"Sending: {response.sum}")
        return response


def main(args=None):
    rclpy.init(args=args)
    node = ConcurrentServiceInterface()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)

    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        print("KeyboardInterrupt, shutting down.\n")
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
