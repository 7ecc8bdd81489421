#!/usr/bin/env python3

import rclpy
from rclpy.node import Node
from rclpy.executors import MultiThreadedExecutor
from rclpy.callback_groups import ReentrantCallbackGroup
from example_interfaces.srv import AddTwoInts
import time


class ServicoConcorrente(Node):

    def __init__(self):
        super().__init__('servico_concorrente')
        self.grupo_servico = ReentrantCallbackGroup()
        self.grupo_timer = ReentrantCallbackGroup()
        self.contador = 0

        # Serviço lento (3 segundos)
        self.srv = self.create_service(AddTwoInts, 'slow_add', self.soma_lenta, callback_group=self.grupo_servico)

        # Timer rápido (10 Hz)
        self.timer = self.create_timer(0.1, self.timer_callback, callback_group=self.grupo_timer)
        self.get_logger().info('Serviço pronto')

    def soma_lenta(self, request, response):
        self.get_logger().info('Recebido: a=%d b=%d' % (request.a, request.b))
        time.sleep(3.0)
        response.result = request.a + request.b
        self.get_logger().info('Enviando resposta: %d' % response.result)
        return response

    def timer_callback(self):
        self.contador += 1
        self.get_logger().info('Timer: %d' % self.contador)


def main(args=None):
    rclpy.init(args=args)
    no = ServicoConcorrente()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(no)
    try:
        executor.spin()
    except Exception as e:
        no.get_logger().error('Erro: %s' % e)
    finally:
        no.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
