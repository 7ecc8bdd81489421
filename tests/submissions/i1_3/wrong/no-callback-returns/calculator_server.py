# Copyright (c) 2023. Port of calculator_service_server.cpp to Python.
import sys

import rclpy
import rclpy.node
import rclpy.executors
from example_interfaces.srv import AddTwoInts


class CalculatorServiceServer(rclpy.node.Node):
    # public:
    def __init__(self):
        super().__init__("calculator_service_server")

        # create the services
        self.add_service_ = self.create_service(AddTwoInts, "/add", self.handle_add)
        self.subtract_service_ = self.create_service(AddTwoInts, "/subtract", self.handle_subtract)
        self.multiply_service_ = self.create_service(AddTwoInts, "/multiply", self.handle_multiply)
        self.divide_service_ = self.create_service(AddTwoInts, "/divide", self.handle_divide)

        self.get_logger().info("Calculator server ready")

    # private:
    def handle_add(self, request, response) -> None:
        response.sum = request.a + request.b
        self.get_logger().info("Incoming request\na: %d b: %d" % (request.a, request.b))
        self.get_logger().info("sending back response: [%d]" % response.sum)

    def handle_subtract(self, request, response) -> None:
        response.sum = request.a - request.b
        self.get_logger().info("Incoming request\na: %d b: %d" % (request.a, request.b))
        self.get_logger().info("sending back response: [%d]" % response.sum)

    def handle_multiply(self, request, response) -> None:
        response.sum = request.a * request.b
        self.get_logger().info("Incoming request\na: %d b: %d" % (request.a, request.b))
        self.get_logger().info("sending back response: [%d]" % response.sum)

    def handle_divide(self, request, response) -> None:
        self.get_logger().info("Incoming request\na: %d b: %d" % (request.a, request.b))
        if request.b == 0:
            self.get_logger().error("Division by zero!")
            response.sum = 0
        else:
            response.sum = request.a // request.b
            self.get_logger().info("sending back response: [%d]" % response.sum)


def main(argc, argv):
    rclpy.init(args=argv)
    node = CalculatorServiceServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main(len(sys.argv), sys.argv))
