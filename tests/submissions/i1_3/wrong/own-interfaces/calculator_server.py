#!/usr/bin/env python3
# -*- coding: utf-8 -*-
# Trabajo practico 3 - Servicios
# Alumno: grupo 7
#
# srv/Calculadora.srv (paquete tp3_interfaces):
#   int64 a
#   int64 b
#   ---
#   int64 sum
#   bool ok
#   string mensaje
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from tp3_interfaces.srv import Calculadora


class ServidorCalculadora(Node):

    def __init__(self):
        super().__init__('servidor_calculadora')
        self.srv_suma = self.create_service(Calculadora, 'add', self.cb_suma)
        self.srv_resta = self.create_service(Calculadora, 'subtract', self.cb_resta)
        self.srv_mult = self.create_service(Calculadora, 'multiply', self.cb_mult)
        self.srv_div = self.create_service(Calculadora, 'divide', self.cb_div)
        self.get_logger().info('Servidor listo')

    def responder(self, response, resultado):
        response.sum = resultado
        response.ok = True
        response.mensaje = 'ok'
        return response

    def cb_suma(self, request, response):
        return self.responder(response, request.a + request.b)

    def cb_resta(self, request, response):
        return self.responder(response, request.a - request.b)

    def cb_mult(self, request, response):
        return self.responder(response, request.a * request.b)

    def cb_div(self, request, response):
        if request.b == 0:
            response.ok = False
            response.mensaje = 'No se puede dividir por cero'
            self.get_logger().error(response.mensaje)
            return response
        return self.responder(response, request.a // request.b)


def main(args=None):
    rclpy.init(args=args)
    nodo = ServidorCalculadora()
    try:
        rclpy.spin(nodo)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        nodo.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
