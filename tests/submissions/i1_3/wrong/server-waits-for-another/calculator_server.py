"""Asks the battery for its state first, as the robot's own nodes do."""

import operator

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node
from std_srvs.srv import Trigger


class Calculator(Node):
    def __init__(self):
        super().__init__("calculator_server")
        self.battery = self.create_client(Trigger, "battery/state")
        while not self.battery.wait_for_service(timeout_sec=1.0):
            self.get_logger().info("no battery yet")
        for name in ("add", "subtract", "multiply", "divide"):
            self.create_service(AddTwoInts, name, getattr(self, name))

    def add(self, request, response):
        return self.compute(operator.add, request, response)

    def subtract(self, request, response):
        return self.compute(operator.sub, request, response)

    def multiply(self, request, response):
        return self.compute(operator.mul, request, response)

    def divide(self, request, response):
        return self.compute(operator.floordiv, request, response)

    def compute(self, function, request, response):
        try:
            response.sum = function(request.a, request.b)
        except ZeroDivisionError as error:
            self.get_logger().error(f"{request.a} / {request.b}: {error}")
        return response


def main():
    rclpy.init()
    try:
        rclpy.spin(Calculator())
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
