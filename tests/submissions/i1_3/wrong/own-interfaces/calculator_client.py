#!/usr/bin/env python3
# -*- coding: utf-8 -*-
# Trabajo practico 3 - Servicios (cliente)
import rclpy
from rclpy.node import Node
from tp3_interfaces.srv import Calculadora


class ClienteCalculadora(Node):

    def __init__(self):
        super().__init__('cliente_calculadora')

    def llamar(self, operacion, a, b):
        cliente = self.create_client(Calculadora, operacion)
        while not cliente.wait_for_service(timeout_sec=1.0):
            self.get_logger().info('Esperando al servicio %s...' % operacion)
        pedido = Calculadora.Request()
        pedido.a = a
        pedido.b = b
        futuro = cliente.call_async(pedido)
        rclpy.spin_until_future_complete(self, futuro)
        respuesta = futuro.result()
        if respuesta.ok:
            self.get_logger().info('%s(%d, %d) = %d' % (operacion, a, b, respuesta.sum))
        else:
            self.get_logger().warn('%s(%d, %d): %s' % (operacion, a, b, respuesta.mensaje))


def main(args=None):
    rclpy.init(args=args)
    nodo = ClienteCalculadora()
    nodo.llamar('add', 10, 5)
    nodo.llamar('subtract', 10, 5)
    nodo.llamar('multiply', 10, 5)
    nodo.llamar('divide', 10, 5)
    nodo.llamar('divide', 10, 0)
    nodo.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
