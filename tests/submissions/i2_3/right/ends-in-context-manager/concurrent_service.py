#!/usr/bin/env python3
"""동시 서비스 노드.

- /slow_add : 3초 걸리는 덧셈 서비스 (모의 하드웨어)
- 10 Hz 타이머 : 서비스 처리 중에도 계속 동작해야 함
"""
from __future__ import annotations

import threading
import time
from typing import Optional

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class RosSession:
    """rclpy.init()/try_shutdown()을 with 문으로 묶는다 (Jazzy에는 아직 없음)."""

    def __init__(self, args: Optional[list] = None) -> None:
        self._args = args

    def __enter__(self) -> 'RosSession':
        rclpy.init(args=self._args)
        return self

    def __exit__(self, exc_type, exc, tb) -> bool:
        rclpy.try_shutdown()
        # Ctrl+C는 정상 종료로 취급
        return exc_type is not None and issubclass(
            exc_type, (KeyboardInterrupt, ExternalShutdownException))


class FakeAdder:
    """느린 장치 흉내. 상태가 없으므로 여러 스레드에서 불러도 된다."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self._abort = threading.Event()

    def add(self, x: int, y: int) -> int:
        self._abort.wait(self.seconds)
        return x + y

    def abort(self) -> None:
        self._abort.set()


class ConcurrentServiceNode(Node):

    def __init__(self, device: FakeAdder) -> None:
        super().__init__('concurrent_service')
        self._device = device
        self._started = time.monotonic()
        self._ticks = 0

        self._srv = self.create_service(
            AddTwoInts, '/slow_add', self._on_slow_add,
            callback_group=ReentrantCallbackGroup())
        # 콜백이 짧으므로 타이머 자신은 겹칠 필요가 없다고 생각했지만, 과제가 reentrant를 요구함
        self._timer = self.create_timer(
            0.1, self._on_tick, callback_group=ReentrantCallbackGroup())
        # 상태 보고용 (과제에는 없음)
        self._report = self.create_timer(
            30.0, self._on_report, callback_group=MutuallyExclusiveCallbackGroup())
        self.get_logger().info('노드 시작')

    def _on_slow_add(self, request: AddTwoInts.Request,
                     response: AddTwoInts.Response) -> AddTwoInts.Response:
        response.sum = self._device.add(request.a, request.b)
        self.get_logger().info(f'{request.a} + {request.b} = {response.sum}')
        return response

    def _on_tick(self) -> None:
        self._ticks += 1
        elapsed = time.monotonic() - self._started
        if self._ticks % 5 == 0:
            self.get_logger().info(f'tick {self._ticks} (t={elapsed:.2f} s)')

    def _on_report(self) -> None:
        self.get_logger().debug('살아 있음')


def main(args: Optional[list] = None) -> None:
    with RosSession(args):
        device = FakeAdder(3.0)
        node = ConcurrentServiceNode(device)
        executor = MultiThreadedExecutor(num_threads=8)
        executor.add_node(node)
        try:
            executor.spin()
        finally:
            device.abort()
            time.sleep(0.1)  # 진행 중인 콜백이 끝나도록
            node.destroy_node()


if __name__ == '__main__':
    main()
