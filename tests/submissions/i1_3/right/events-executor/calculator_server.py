import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.experimental import EventsExecutor
from rclpy.node import Node


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.create_service(AddTwoInts, 'add', lambda q, r: self.answer(r, q.a + q.b))
        self.create_service(AddTwoInts, 'subtract', lambda q, r: self.answer(r, q.a - q.b))
        self.create_service(AddTwoInts, 'multiply', lambda q, r: self.answer(r, q.a * q.b))
        self.create_service(AddTwoInts, 'divide', self.divide)

    def answer(self, response, result):
        response.sum = result
        return response

    def divide(self, request, response):
        if request.b == 0:
            self.get_logger().error('Division by zero!')
            return self.answer(response, 0)
        return self.answer(response, request.a // request.b)


def main():
    rclpy.init()
    executor = EventsExecutor()
    executor.add_node(CalculatorServer())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
