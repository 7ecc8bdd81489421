#!/usr/bin/env python3

# ros imports
import rclpy
from rclpy.node import Node

# ros interfaces
from example_interfaces.srv import AddTwoInts

# python packages
import csv
import io
import time


class CalculatorProbe(Node):
    """ calls every operation once and prints a small table (name, a, b, result, ms) """

    def __init__(self):
        super().__init__('calculator_probe')
        self.rows = []

    def probe(self, name, a, b):
        client = self.create_client(AddTwoInts, name)
        if not client.wait_for_service(timeout_sec=10.0):
            raise RuntimeError(f'{name} not available')
        t0 = time.perf_counter()
        future = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, future, timeout_sec=5.0)
        dt = (time.perf_counter() - t0) * 1000
        self.rows.append((name, a, b, future.result().sum, f'{dt:.2f}'))
        self.destroy_client(client)

    def table(self):
        out = io.StringIO()
        writer = csv.writer(out)
        writer.writerow(('name', 'a', 'b', 'result', 'ms'))
        writer.writerows(self.rows)
        return out.getvalue()


def main(args=None):
    rclpy.init(args=args)
    node = CalculatorProbe()
    for name in ('add', 'subtract', 'multiply', 'divide'):
        node.probe(name, 144, 12)
    print(node.table())
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
