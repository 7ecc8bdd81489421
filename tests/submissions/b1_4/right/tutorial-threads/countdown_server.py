import time

import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

from example_interfaces.action import Fibonacci


class CountdownServer(Node):

    def __init__(self):
        super().__init__('countdown_action_server')
        self.current = None
        self._action_server = ActionServer(
            self,
            Fibonacci,
            'countdown',
            execute_callback=self.execute_callback,
            callback_group=ReentrantCallbackGroup(),
            goal_callback=self.goal_callback,
            cancel_callback=self.cancel_callback)

    def destroy(self):
        self._action_server.destroy()
        super().destroy_node()

    def goal_callback(self, goal_request):
        self.get_logger().info('Received goal request')
        return GoalResponse.ACCEPT if goal_request.order >= 0 else GoalResponse.REJECT

    def cancel_callback(self, goal_handle):
        self.get_logger().info('Received cancel request')
        return CancelResponse.ACCEPT

    def execute_callback(self, goal_handle):
        self.get_logger().info('Executing goal...')
        self.current = goal_handle.goal_id

        feedback_msg = Fibonacci.Feedback()
        feedback_msg.sequence = [goal_handle.request.order]
        result = Fibonacci.Result()

        while feedback_msg.sequence[-1] > 0:
            goal_handle.publish_feedback(feedback_msg)
            time.sleep(0.25)
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                self.get_logger().info('Goal canceled')
                result.sequence = feedback_msg.sequence
                return result
            if self.current != goal_handle.goal_id:
                goal_handle.abort()
                self.get_logger().info('Goal aborted')
                return result
            feedback_msg.sequence.append(feedback_msg.sequence[-1] - 1)

        goal_handle.succeed()
        result.sequence = feedback_msg.sequence
        self.get_logger().info('Returning result: {0}'.format(result.sequence))
        return result


def main(args=None):
    rclpy.init(args=args)
    countdown_server = CountdownServer()
    executor = MultiThreadedExecutor(num_threads=4)
    try:
        rclpy.spin(countdown_server, executor=executor)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    countdown_server.destroy()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
