#!/usr/bin/env python3
"""느린 계산 서비스 노드.

    /slow_add, /slow_subtract, /slow_multiply  (example_interfaces/AddTwoInts)

각 호출은 3초가 걸리고, 그동안에도 10 Hz 타이머는 멈추지 않습니다.

연산을 추가하려면 `OPERATIONS` 에 한 줄만 더하면 됩니다.
"""

import threading
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

OPERATIONS = {
    'slow_add':      lambda a, b: a + b,
    'slow_subtract': lambda a, b: a - b,
    'slow_multiply': lambda a, b: a * b,
}


class SlowCalculator(Node):

    def __init__(self):
        super().__init__('slow_calculator')
        p = self.declare_parameter

        p('processing_time', 3.0)
        p('timer_rate', 10.0)

        g = lambda n: self.get_parameter(n).value          # noqa: E731
        self.processing_time = g('processing_time')

        self.cb = ReentrantCallbackGroup()
        self.lock = threading.Lock()
        self.done = {name: 0 for name in OPERATIONS}
        self.ticks = 0

        for name, op in OPERATIONS.items():
            self.create_service(
                AddTwoInts, name,
                lambda req, res: self._srv_calc(name, op, req, res),
                callback_group=self.cb)

        self.create_timer(1.0 / g('timer_rate'), self._tick, callback_group=self.cb)

        self.get_logger().info(
            '계산 노드 시작 — 가능한 연산: %s' % ', '.join(sorted(OPERATIONS)))

    # ---------------- 서비스 ----------------

    def _srv_calc(self, name, op, req, res):
        t0 = time.time()
        while time.time() - t0 < self.processing_time:
            time.sleep(0.05)
        res.sum = op(req.a, req.b)
        with self.lock:
            self.done[name] += 1
        return res

    # ---------------- 타이머 ----------------

    def _tick(self):
        self.ticks += 1
        if self.ticks % 10 == 0:
            self.get_logger().info('타이머 틱 %d' % self.ticks)


def main():
    rclpy.init()
    n = SlowCalculator()
    ex = MultiThreadedExecutor(num_threads=8)
    ex.add_node(n)
    try:
        ex.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        ex.shutdown()
        n.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
