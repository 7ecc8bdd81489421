"""The goal is worked on in a thread of its own; the executor's only thread stays free."""
from itertools import count
from queue import Empty, Queue
from threading import Thread

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.task import Future


class Worker(Thread):
    def __init__(self, handle, done):
        super().__init__(daemon=True)
        self.handle, self.done, self.inbox = handle, done, Queue()

    def run(self):
        numbers = []
        for i in count():
            numbers.append(self.handle.request.order - i)
            self.handle.publish_feedback(Fibonacci.Feedback(sequence=numbers))
            if numbers[-1] <= 0:
                self.handle.succeed()
                break
            try:
                word = self.inbox.get(timeout=0.25)
            except Empty:
                word = ''
            if word == 'quit':
                return
            if word == 'replaced':
                self.handle.abort()
                break
            if self.handle.is_cancel_requested:
                self.handle.canceled()
                break
        self.done.set_result(numbers)


class Countdown:
    def __init__(self, node):
        self.worker = None
        self.server = ActionServer(
            node, Fibonacci, 'countdown', self.execute,
            goal_callback=self.accept, cancel_callback=lambda handle: CancelResponse.ACCEPT,
            feedback_pub_qos_profile=QoSProfile(depth=50, reliability=ReliabilityPolicy.RELIABLE),
            result_timeout=60,
        )

    def accept(self, goal):
        return GoalResponse.ACCEPT if goal.order in range(1000) else GoalResponse.REJECT

    async def execute(self, handle):
        if self.worker:
            self.worker.inbox.put('replaced')
        done = Future()
        self.worker = Worker(handle, done)
        self.worker.start()
        return Fibonacci.Result(sequence=await done)


def main():
    rclpy.init()
    node = rclpy.create_node('countdown_node')
    countdown = Countdown(node)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        while rclpy.ok():
            executor.spin_once(timeout_sec=0.05)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if countdown.worker:
            countdown.worker.inbox.put('quit')
            countdown.worker.join(1.0)
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
