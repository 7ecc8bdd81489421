from __future__ import annotations

import itertools
import threading
from contextlib import suppress

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

WORK_S = 3.0
TICK_S = 0.1


class Ticking:
    """Mixin: a steady tick in the log."""

    def __init__(self, *args, **kwargs) -> None:
        super().__init__(*args, **kwargs)
        self.__numbers = itertools.count(start=1)
        self.create_timer(TICK_S, self.__tick, callback_group=ReentrantCallbackGroup())

    def __tick(self) -> None:
        self.get_logger().info('tick #%d' % next(self.__numbers))


class Adding:
    """Mixin: /slow_add, several at a time."""

    def __init__(self, *args, **kwargs) -> None:
        super().__init__(*args, **kwargs)
        self._leaving = threading.Event()
        self.create_service(
            AddTwoInts, '/slow_add', self.__add, callback_group=ReentrantCallbackGroup()
        )

    def __add(self, req: AddTwoInts.Request, res: AddTwoInts.Response) -> AddTwoInts.Response:
        # nobody sets the event before the end, so this is a sleep one can leave early
        if self._leaving.wait(WORK_S):
            return res
        res.sum = req.a + req.b
        return res

    def leave(self) -> None:
        self._leaving.set()


class ConcurrentService(Ticking, Adding, Node):
    pass


def main() -> None:
    rclpy.init()
    node = ConcurrentService('concurrent_service')
    pool = MultiThreadedExecutor(8)
    pool.add_node(node)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        pool.spin()
    node.leave()
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
