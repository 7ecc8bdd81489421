import threading

import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from example_interfaces.action import Fibonacci


class CountdownServer(Node):
    def __init__(self):
        super().__init__("countdown_server")
        self.busy = False
        self.replace = False
        self.stop = threading.Event()
        self.server = ActionServer(
            self, Fibonacci, "countdown", self.execute,
            goal_callback=self.on_goal,
            cancel_callback=self.on_cancel,
            handle_accepted_callback=self.on_accepted)

    def on_goal(self, goal):
        if goal.order < 0:
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def on_cancel(self, handle):
        return CancelResponse.ACCEPT

    def on_accepted(self, handle):
        if self.busy:
            self.replace = True
        self.busy = True
        handle.execute()

    def execute(self, handle):
        numbers = []
        result = Fibonacci.Result()
        for number in range(handle.request.order, -1, -1):
            numbers.append(number)
            if not rclpy.ok():
                return result
            handle.publish_feedback(Fibonacci.Feedback(sequence=numbers))
            if number == 0:
                break
            self.stop.wait(0.25)
            if self.stop.is_set() or not rclpy.ok():
                return result
            if handle.is_cancel_requested:
                handle.canceled()
                result.sequence = numbers
                return result
            if self.replace:
                self.replace = False
                handle.abort()
                result.sequence = numbers
                return result
        self.busy = False
        handle.succeed()
        result.sequence = numbers
        return result


def main():
    rclpy.init()
    node = CountdownServer()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.stop.set()
        executor.shutdown()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
