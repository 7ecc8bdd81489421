#!/usr/bin/env python3
# -*- coding: utf-8 -*-
"""계산기 서비스 노드.  /add /subtract /multiply /divide 네 개의 서비스를 연다."""
import sys

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

NAMES = ('add', 'subtract', 'multiply', 'divide')


class CalcFlow(Node):

    def __init__(self):
        super().__init__('calc_flow')
        self.served = dict.fromkeys(NAMES, 0)      # 몇 번 불렸는지
        self.failed = 0
        for name in NAMES:
            self.create_service(AddTwoInts, f'/{name}', getattr(self, f'_on_{name}'))
        self.get_logger().info(f"준비 완료 — {', '.join('/' + n for n in NAMES)}")

    # ------------------------------------------------------------ 서비스
    def _on_add(self, request, response):
        response.sum = request.a + request.b
        return self._done('add', request, response)

    def _on_subtract(self, request, response):
        response.sum = request.a - request.b
        return self._done('subtract', request, response)

    def _on_multiply(self, request, response):
        response.sum = request.a * request.b
        return self._done('multiply', request, response)

    def _on_divide(self, request, response):
        if request.b == 0:                          # 0 으로 나누기: 죽지 말고 알려 준다
            self.failed += 1
            self.get_logger().error(
                f'/divide: {request.a} 을(를) 0 으로 나눌 수 없다 (division by zero) — {self.failed} 번째')
            response.sum = 0
            return response
        response.sum = request.a // request.b
        return self._done('divide', request, response)

    # ------------------------------------------------------------ 공통
    def _done(self, name, request, response):
        self.served[name] += 1
        self.get_logger().info(
            f'/{name} #{self.served[name]}: a={request.a} b={request.b} -> {response.sum}')
        return response


def main(argv=None):
    rclpy.init(args=argv)
    node = CalcFlow()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
