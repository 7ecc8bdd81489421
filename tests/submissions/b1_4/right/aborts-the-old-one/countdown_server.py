import threading
import time

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class MinimalActionServer(Node):
    """As in rclpy's example of a single goal: the old goal is aborted from outside."""

    def __init__(self):
        super().__init__('minimal_action_server')
        self._goal_handle = None
        self._goal_lock = threading.Lock()
        self._action_server = ActionServer(
            self, Fibonacci, 'countdown',
            execute_callback=self.execute_callback,
            goal_callback=self.goal_callback,
            handle_accepted_callback=self.handle_accepted_callback,
            cancel_callback=self.cancel_callback,
            callback_group=ReentrantCallbackGroup())

    def goal_callback(self, goal_request):
        if goal_request.order < 0:
            self.get_logger().error('negative')
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def handle_accepted_callback(self, goal_handle):
        with self._goal_lock:
            if self._goal_handle is not None and self._goal_handle.is_active:
                self.get_logger().info('Aborting previous goal')
                self._goal_handle.abort()
            self._goal_handle = goal_handle
        goal_handle.execute()

    def cancel_callback(self, goal):
        return CancelResponse.ACCEPT

    def execute_callback(self, goal_handle):
        feedback_msg = Fibonacci.Feedback()
        for i in range(goal_handle.request.order, 0, -1):
            if not goal_handle.is_active:
                self.get_logger().info('Goal aborted')
                return Fibonacci.Result()
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return Fibonacci.Result(sequence=feedback_msg.sequence)
            feedback_msg.sequence.append(i)
            if not rclpy.ok():
                return Fibonacci.Result()
            goal_handle.publish_feedback(feedback_msg)
            time.sleep(0.25)
        with self._goal_lock:
            if not goal_handle.is_active:
                return Fibonacci.Result()
            goal_handle.succeed()
        feedback_msg.sequence.append(0)
        return Fibonacci.Result(sequence=feedback_msg.sequence)


def main(args=None):
    rclpy.init(args=args)
    try:
        action_server = MinimalActionServer()
        executor = MultiThreadedExecutor(num_threads=3)
        rclpy.spin(action_server, executor=executor)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
