import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        self.create_service(AddTwoInts, 'add', self.add)
        self.create_service(AddTwoInts, 'subtract', self.subtract)
        self.create_service(AddTwoInts, 'multiply', self.multiply)
        self.create_service(AddTwoInts, 'divide', self.divide)

    def add(self, req, resp):
        resp.sum = req.a + req.b
        return resp

    def subtract(self, req, resp):
        resp.sum = req.a - req.b
        return resp

    def multiply(self, req, resp):
        resp.sum = req.a * req.b
        return resp

    def divide(self, req, resp):
        if req.b == 0:
            self.get_logger().error('Division by zero')
            resp.sum = 0
        else:
            resp.sum = req.a / req.b
        return resp


def main():
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except Exception as error:
        node.get_logger().fatal(f'{type(error).__name__}: {error}')
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
