from threading import Thread
from time import sleep

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts

TIMER_RATE = 10  # Hz
WORK_SECONDS = 3


class Statistics(Thread):
    """Prints how busy the service was, every now and then."""

    def __init__(self, node: 'SlowAddNode', period: int = 30) -> None:
        super().__init__(name='statistics')
        self.node = node
        self.period = period
        self.calls = 0
        self.start()

    def call_finished(self) -> None:
        self.calls += 1

    def run(self) -> None:
        while True:
            sleep(self.period)
            print(f'{self.node.get_name()}: {self.calls} calls so far', flush=True)


class SlowAddNode(Node):
    def __init__(self) -> None:
        super().__init__(
            'slow_add_node',
            parameter_overrides=[],
        )
        self.tick = 0
        self.group = ReentrantCallbackGroup()

        self.srv = self.create_service(
            AddTwoInts,
            'slow_add',
            self.service_callback,
            callback_group=self.group,
        )

        self.timer = self.create_timer(
            1 / TIMER_RATE,
            self.timer_callback,
            callback_group=self.group,
        )

        self.statistics = Statistics(self)

    def service_callback(self, request: AddTwoInts.Request,
                         response: AddTwoInts.Response) -> AddTwoInts.Response:
        sleep(WORK_SECONDS)
        response.sum = request.a + request.b
        self.statistics.call_finished()
        return response

    def timer_callback(self) -> None:
        self.tick += 1
        if self.tick % TIMER_RATE == 0:
            self.get_logger().info(f'Tick {self.tick}')


def main() -> None:
    rclpy.init()
    slow_add_node = SlowAddNode()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(slow_add_node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
