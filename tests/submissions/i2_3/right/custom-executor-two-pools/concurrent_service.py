# A custom executor, after the priority executor of the rclpy examples: timers
# get threads of their own, so that no amount of slow work can delay them.

from concurrent.futures import ThreadPoolExecutor
import time

from example_interfaces.srv import AddTwoInts
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import Executor
from rclpy.executors import ExternalShutdownException
from rclpy.executors import ShutdownException
from rclpy.executors import TimeoutException
from rclpy.node import Node
from rclpy.timer import Timer


class Adder(Node):

    def __init__(self):
        super().__init__('concurrent_service')
        self.group = ReentrantCallbackGroup()
        self.count = 0
        self.srv = self.create_service(
            AddTwoInts, 'slow_add', self.add_callback, callback_group=self.group)
        self.tmr = self.create_timer(0.1, self.timer_callback, callback_group=self.group)

    def timer_callback(self):
        self.count += 1
        if self.count % 5 == 0:
            self.get_logger().info('tick [%d]' % self.count)

    def add_callback(self, request, response):
        self.get_logger().info('adding [%d] and [%d], come back later' % (request.a, request.b))
        time.sleep(3.0)
        response.sum = request.a + request.b
        return response


class TwoLaneExecutor(Executor):
    """
    Execute timers in one pool of threads and everything else in another one.

    A custom executor only has to say what happens to one piece of work; the
    work itself comes from `wait_for_ready_callbacks`.
    """

    def __init__(self, fast_threads=2, slow_threads=6):
        super().__init__()
        self.fast_lane = ThreadPoolExecutor(max_workers=fast_threads, thread_name_prefix='fast')
        self.slow_lane = ThreadPoolExecutor(max_workers=slow_threads, thread_name_prefix='slow')

    def spin_once(self, timeout_sec=None):
        try:
            handler, entity, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except (ShutdownException, TimeoutException):
            return
        if isinstance(entity, Timer):
            self.fast_lane.submit(handler)
        else:
            self.slow_lane.submit(handler)

    def shutdown(self, timeout_sec=None):
        self.fast_lane.shutdown(wait=False)
        self.slow_lane.shutdown(wait=False)
        return super().shutdown(timeout_sec)


def main(args=None):
    rclpy.init(args=args)
    try:
        executor = TwoLaneExecutor()
        adder = Adder()
        executor.add_node(adder)
        try:
            executor.spin()
        finally:
            executor.shutdown()
            adder.destroy_node()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
