import sys

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Calculadora(Node):
    def __init__(self):
        super().__init__('calculadora')
        self.create_service(AddTwoInts, 'add', self.sumar)
        self.create_service(AddTwoInts, 'subtract', self.restar)
        self.create_service(AddTwoInts, 'multiply', self.multiplicar)
        self.create_service(AddTwoInts, 'divide', self.dividir)
        self.get_logger().info('Calculadora lista')

    def sumar(self, req, resp):
        resp.sum = req.a + req.b
        return resp

    def restar(self, req, resp):
        resp.sum = req.a - req.b
        return resp

    def multiplicar(self, req, resp):
        resp.sum = req.a * req.b
        return resp

    def dividir(self, req, resp):
        if req.b == 0:
            self.get_logger().info('No se puede dividir entre cero')
            resp.sum = -sys.maxsize - 1
            return resp
        resp.sum = req.a // req.b
        return resp


def main():
    rclpy.init()
    try:
        rclpy.spin(Calculadora())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
