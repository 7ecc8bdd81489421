import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from example_interfaces.srv import AddTwoInts


heartbeat_period = 5.0

class CalculatorServer(Node):

    def __init__(self):
        super().__init__('calculator_server')
        self.log = self.get_logger()
        self.beats = 0
        self.timer = self.create_timer(heartbeat_period, self.heartbeat)
        self.srv_add = self.create_service(AddTwoInts, 'add', self.add)
        self.srv_sub = self.create_service(AddTwoInts, 'subtract', self.subtract)
        self.srv_mul = self.create_service(AddTwoInts, 'multiply', self.multiply)
        self.srv_div = self.create_service(AddTwoInts, 'divide', self.divide)

    def heartbeat(self):
        self.beats += 1
        self.log.info('heartbeat %d' % self.beats)

    def add(self, request, response):
        response.sum = request.a + request.b
        self.log.info('add -> %d' % response.sum)
        return response

    def subtract(self, request, response):
        response.sum = request.a - request.b
        self.log.info('subtract -> %d' % response.sum)
        return response

    def multiply(self, request, response):
        response.sum = request.a * request.b
        self.log.info('multiply -> %d' % response.sum)
        return response

    def divide(self, request, response):
        if request.b == 0:
            self.log.error('divide -> division by zero')
            response.sum = 0
        else:
            response.sum = request.a // request.b
            self.log.info('divide -> %d' % response.sum)
        return response

    def spin(self):
        try:
            rclpy.spin(self)
        except (KeyboardInterrupt, ExternalShutdownException):
            pass


def main():
    rclpy.init()
    calculator_server = CalculatorServer()
    calculator_server.spin()
    calculator_server.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
