#!/usr/bin/env python3
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, State, TransitionCallbackReturn

from example_interfaces.srv import AddTwoInts


class CalculatorServer(LifecycleNode):
    """Managed calculator: services exist while the node is configured."""

    def __init__(self, node_name, **kwargs):
        super().__init__(node_name, **kwargs)
        self.calculator_services = []
        self.get_logger().info("CalculatorServer: Initializing")

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        self.get_logger().info(f"Node '{self.get_name()}' is in state '{state.label}'. Transitioning to 'configure'")
        self.calculator_services = [
            self.create_service(AddTwoInts, "add", self.add),
            self.create_service(AddTwoInts, "subtract", self.subtract),
            self.create_service(AddTwoInts, "multiply", self.multiply),
            self.create_service(AddTwoInts, "divide", self.divide),
        ]
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        self.get_logger().info(f"Node '{self.get_name()}' is in state '{state.label}'. Transitioning to 'activate'")
        return super().on_activate(state)

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        self.get_logger().info(f"Node '{self.get_name()}' is in state '{state.label}'. Transitioning to 'deactivate'")
        return super().on_deactivate(state)

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        for service in self.calculator_services:
            self.destroy_service(service)
        self.calculator_services = []
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: State) -> TransitionCallbackReturn:
        self.get_logger().info(f"Node '{self.get_name()}' is in state '{state.label}'. Transitioning to 'shutdown'")
        return TransitionCallbackReturn.SUCCESS

    def add(self, request, response):
        response.sum = request.a + request.b
        return response

    def subtract(self, request, response):
        response.sum = request.a - request.b
        return response

    def multiply(self, request, response):
        response.sum = request.a * request.b
        return response

    def divide(self, request, response):
        if request.b == 0:
            self.get_logger().error("Division by zero!")
            response.sum = 0
        else:
            response.sum = request.a // request.b
        return response


def main(args=None) -> None:
    rclpy.init(args=args)
    node = CalculatorServer("calculator_server")
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
