#!/usr/bin/env python3
"""Arithmetic unit of the base driver (ROS 2 version)."""

import signal
import sys

import rclpy
from example_interfaces.srv import AddTwoInts


class ArithmeticUnit:
    """Not a node itself: it gets one, as all our drivers do."""

    def __init__(self, node):
        self._node = node
        self._log = node.get_logger()
        self._n_requests = 0

        node.create_service(AddTwoInts, '/add', self._srv_add)
        node.create_service(AddTwoInts, '/subtract', self._srv_subtract)
        node.create_service(AddTwoInts, '/multiply', self._srv_multiply)
        node.create_service(AddTwoInts, '/divide', self._srv_divide)

        self._log.info('arithmetic unit initialised')

    def _count(self):
        self._n_requests += 1
        if self._n_requests % 100 == 0:
            self._log.info('{} requests served'.format(self._n_requests))

    def _srv_add(self, req, resp):
        self._count()
        resp.sum = req.a + req.b
        return resp

    def _srv_subtract(self, req, resp):
        self._count()
        resp.sum = req.a - req.b
        return resp

    def _srv_multiply(self, req, resp):
        self._count()
        resp.sum = req.a * req.b
        return resp

    def _srv_divide(self, req, resp):
        self._count()
        if req.b == 0:
            self._log.error('Division by zero: %d / %d, returning 0', req.a, req.b)
            resp.sum = 0
            return resp
        resp.sum = req.a // req.b
        return resp


def main():
    rclpy.init(args=sys.argv)
    node = rclpy.create_node('calculator_server')
    unit = ArithmeticUnit(node)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    except rclpy.executors.ExternalShutdownException:
        pass
    rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
