#!/usr/bin/env python3
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class Color:
    RED = "\033[91m"
    GREEN = "\033[92m"
    YELLOW = "\033[93m"
    BLUE = "\033[94m"
    RESET = "\033[0m"


class CalculatorServerInterface(Node):
    """
    Class to demonstrate several service servers in one node.
    All four servers share one mutually exclusive group, so that two requests are never handled at the same time.
    """

    mutex_group = MutuallyExclusiveCallbackGroup()

    def __init__(self, node_name):
        super().__init__(node_name)

        self._add_server = self.create_service(
            AddTwoInts,  # Service type
            "add",  # Service name
            self._handle_add,  # Callback function
            callback_group=CalculatorServerInterface.mutex_group,  # Callback group
        )
        self._subtract_server = self.create_service(
            AddTwoInts,
            "subtract",
            self._handle_subtract,
            callback_group=CalculatorServerInterface.mutex_group,
        )
        self._multiply_server = self.create_service(
            AddTwoInts,
            "multiply",
            self._handle_multiply,
            callback_group=CalculatorServerInterface.mutex_group,
        )
        self._divide_server = self.create_service(
            AddTwoInts,
            "divide",
            self._handle_divide,
            callback_group=CalculatorServerInterface.mutex_group,
        )

        self.get_logger().info(Color.BLUE + "🧮 calculator ready" + Color.RESET)

    def _report(self, request, sign, response):
        """
        Show one request and its response in colour

        Args:
            request (AddTwoInts.Request): what came in
            sign (str): sign of the operation
            response (AddTwoInts.Response): what goes out
        """
        self.get_logger().info(
            Color.YELLOW + f"Incoming request: {request.a} {sign} {request.b}" + Color.RESET
        )
        self.get_logger().info(
            Color.GREEN + f"Sending response: {response.sum}" + Color.RESET
        )

    def _handle_add(self, request, response):
        response.sum = request.a + request.b
        self._report(request, "+", response)
        return response

    def _handle_subtract(self, request, response):
        response.sum = request.a - request.b
        self._report(request, "-", response)
        return response

    def _handle_multiply(self, request, response):
        response.sum = request.a * request.b
        self._report(request, "x", response)
        return response

    def _handle_divide(self, request, response):
        if request.b == 0:
            self.get_logger().error(
                Color.RED + f"🔴 Division by zero requested ({request.a} / 0)" + Color.RESET
            )
            response.sum = 0
            return response

        response.sum = request.a // request.b
        self._report(request, "/", response)
        return response


def main(args=None):
    rclpy.init(args=args)
    node = CalculatorServerInterface("calculator_server")
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)

    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
