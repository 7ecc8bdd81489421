#!/usr/bin/env python3
# -*- coding: utf-8 -*-
# Práctica 2 - Publicador con parámetros
#
# COMPILACIÓN Y EJECUCIÓN
# colcon build --symlink-install
# ros2 run my_package parameterized_publisher --ros-args -p publish_rate:=5.0

import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String


class NodoPublicador(Node):

    PERIODO_VIGILANTE = 0.05   # cada cuánto miramos si la frecuencia ha cambiado (s)

    def __init__(self):
        super().__init__('parameterized_publisher')

        # Declaración de los parámetros (el tipo se coge del valor inicial)
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)

        # Este callback SOLO dice sí o no. El valor nuevo todavía no está guardado
        # cuando se llama, así que aquí no tocamos ningún temporizador.
        self.add_on_set_parameters_callback(self.comprobar)

        self.publicador = self.create_publisher(String, 'chatter', 10)
        self.contador = 0
        self.frecuencia = None
        self.temporizador = None

        if self.leer('publish_rate') <= 0.0:
            self.get_logger().fatal(
                'publish_rate tiene que ser mayor que cero (es %s), no arranco' % self.leer('publish_rate'))
            raise SystemExit(1)

        self.vigilar()
        self.vigilante = self.create_timer(self.PERIODO_VIGILANTE, self.vigilar)
        self.get_logger().info('Nodo iniciado a %.2f Hz' % self.frecuencia)

    def leer(self, nombre):
        return self.get_parameter(nombre).value

    def comprobar(self, parametros):
        """Acepta o rechaza, sin efectos secundarios."""
        for p in parametros:
            if p.name == 'publish_rate' and p.value <= 0.0:
                motivo = 'publish_rate debe ser positivo, no %s' % p.value
                self.get_logger().error(motivo)
                return SetParametersResult(successful=False, reason=motivo)
        return SetParametersResult(successful=True)

    def vigilar(self):
        """Si la frecuencia guardada no es la que usamos, cambiamos el temporizador."""
        deseada = self.leer('publish_rate')
        if deseada == self.frecuencia:
            return
        if self.temporizador is not None:
            self.temporizador.cancel()
            self.destroy_timer(self.temporizador)
        self.temporizador = self.create_timer(1.0 / deseada, self.publicar)
        self.frecuencia = deseada
        self.get_logger().info('Frecuencia: %.2f Hz' % deseada)

    def publicar(self):
        if not self.leer('enabled'):
            return
        mensaje = String()
        mensaje.data = '%s: %d' % (self.leer('message_prefix'), self.contador)
        self.publicador.publish(mensaje)
        self.contador += 1


def main(args=None):
    rclpy.init(args=args)
    nodo = None
    try:
        nodo = NodoPublicador()
        rclpy.spin(nodo)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if nodo is not None:
            nodo.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
