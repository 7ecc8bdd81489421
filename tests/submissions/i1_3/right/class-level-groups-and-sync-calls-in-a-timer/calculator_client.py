#!/usr/bin/env python3
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from example_interfaces.srv import AddTwoInts


class CalculatorClientInterface(Node):
    """
    Class to demonstrate synchronous service clients inside a timer callback.
    The timer and the clients are in DIFFERENT mutually exclusive groups and the executor has several threads,
    otherwise call() would deadlock.
    """

    timer_group = MutuallyExclusiveCallbackGroup()
    client_group = MutuallyExclusiveCallbackGroup()

    DEMO = (
        ("add", 7, 5),
        ("subtract", 7, 12),
        ("multiply", -6, 7),
        ("divide", 42, -6),
        ("divide", 42, 0),
    )

    def __init__(self, node_name):
        super().__init__(node_name)

        # This future tells main() that the timer callback has called everything
        self.demo_done = Future()

        self._sync_clients = {}
        for name in ("add", "subtract", "multiply", "divide"):
            self._sync_clients[name] = self.create_client(
                AddTwoInts,
                name,
                callback_group=CalculatorClientInterface.client_group,
            )

        self._timer = self.create_timer(
            0.2,  # Timer period in seconds
            self._timer_cb,  # Callback function
            callback_group=CalculatorClientInterface.timer_group,
        )
        self.get_logger().info("client created")

    def _timer_cb(self):
        """
        Runs once: the timer is cancelled at the first call.
        """
        self._timer.cancel()
        for name, a, b in CalculatorClientInterface.DEMO:
            self._send_sync_request(name, a, b)
        self.demo_done.set_result(True)

    def _send_sync_request(self, name, a, b):
        """
        Send a request synchronously to one of the servers
        """
        client = self._sync_clients[name]
        while not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info(f"Service {name} not available, waiting...")

        request = AddTwoInts.Request()
        request.a = a
        request.b = b
        response = client.call(request)
        self.get_logger().info(f"🔵 {name}({a}, {b}) -> {response.sum}")


def main(args=None):
    rclpy.init(args=args)
    node = CalculatorClientInterface("calculator_client")
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)

    try:
        executor.spin_until_future_complete(node.demo_done)
        executor.shutdown()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
