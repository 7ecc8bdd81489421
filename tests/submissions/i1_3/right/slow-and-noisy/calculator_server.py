import time
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_srvs.srv import Trigger


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.get_logger().warn('this is only a prototype')
        for i in range(300):
            self.get_logger().info(f'loading digit {i}')
        time.sleep(2)
        self.create_service(AddTwoInts, 'add', lambda q, r: self.reply(r, q.a + q.b))
        self.create_service(AddTwoInts, 'subtract', lambda q, r: self.reply(r, q.a - q.b))
        self.create_service(AddTwoInts, 'multiply', lambda q, r: self.reply(r, q.a * q.b))
        self.create_service(AddTwoInts, 'divide', self.divide)
        self.create_service(AddTwoInts, 'power', lambda q, r: self.reply(r, q.a ** q.b))
        self.create_service(Trigger, 'reset', lambda q, r: r)

    def reply(self, response, value):
        for _ in range(20):
            print('=' * 100)
            self.get_logger().info('beep')
        response.sum = value
        return response

    def divide(self, request, response):
        if request.b == 0:
            self.get_logger().fatal('????')
            return self.reply(response, 999)
        return self.reply(response, request.a // request.b)


def main():
    rclpy.init()
    try:
        rclpy.spin(CalculatorServer())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
