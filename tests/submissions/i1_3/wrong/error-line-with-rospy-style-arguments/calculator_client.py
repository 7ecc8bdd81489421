#!/usr/bin/env python3
"""Self-test of the arithmetic unit (ROS 2 version)."""

import sys

import rclpy
from example_interfaces.srv import AddTwoInts

TESTS = (
    # service       a    b
    ('/add',       17,   4),
    ('/subtract',  17,   4),
    ('/multiply',  17,  -4),
    ('/divide',    68,   4),
)


def main():
    rclpy.init(args=sys.argv)
    node = rclpy.create_node('calculator_client')
    log = node.get_logger()

    proxies = {name: node.create_client(AddTwoInts, name) for name, _, _ in TESTS}
    pending = list(proxies)
    while pending:
        if proxies[pending[0]].wait_for_service(timeout_sec=0.5):
            log.info('{} found'.format(pending.pop(0)))

    futures = []
    for name, a, b in TESTS:
        futures.append((name, a, b, proxies[name].call_async(AddTwoInts.Request(a=a, b=b))))

    for name, a, b, future in futures:
        rclpy.spin_until_future_complete(node, future)
        log.info('{}({}, {}) = {}'.format(name, a, b, future.result().sum))

    node.destroy_node()
    rclpy.shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
