#!/usr/bin/env python3
"""A timer does the steps; the execute callback only waits for its result."""
import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future


class Job:
    def __init__(self, handle):
        self.handle = handle
        self.left = list(range(handle.request.order, -1, -1))
        self.counted = []
        self.done = Future()

    def finish(self, how):
        how()
        self.done.set_result(Fibonacci.Result(sequence=self.counted))


class Server(Node):
    def __init__(self):
        super().__init__('timer_server')
        self.job = None
        self.action = ActionServer(
            self, Fibonacci, 'countdown', self.execute,
            goal_callback=self.check,
            handle_accepted_callback=self.accepted,
            cancel_callback=self.cancel)
        self.create_timer(0.25, self.step)

    def check(self, goal):
        if goal.order < 0:
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def cancel(self, _):
        return CancelResponse.ACCEPT

    def accepted(self, handle):
        if self.job:
            self.job.finish(self.job.handle.abort)
        self.job = Job(handle)
        handle.execute()

    async def execute(self, handle):
        return await self.job.done

    def step(self):
        job = self.job
        if job is None:
            return
        if job.handle.is_cancel_requested:
            job.finish(job.handle.canceled)
            self.job = None
        elif job.left:
            job.counted.append(job.left.pop(0))
            job.handle.publish_feedback(Fibonacci.Feedback(sequence=job.counted))
        else:
            job.finish(job.handle.succeed)
            self.job = None


def main():
    rclpy.init()
    server = Server()
    try:
        rclpy.spin(server)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
