"""One thread: the goal is a coroutine that awaits its pauses."""
import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.executors import ExternalShutdownException
from rclpy.task import Future


class Countdown(rclpy.node.Node):
    def __init__(self):
        super().__init__("countdown")
        self.generation = 0
        self.server = ActionServer(
            self, Fibonacci, "/countdown", self.run,
            goal_callback=lambda goal: GoalResponse.REJECT if goal.order < 0 else GoalResponse.ACCEPT,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )

    async def sleep(self, seconds):
        woken = Future()
        timer = self.create_timer(seconds, lambda: woken.set_result(None))
        await woken
        timer.cancel()
        self.destroy_timer(timer)

    async def run(self, goal_handle):
        self.generation += 1
        mine = self.generation
        numbers = [goal_handle.request.order]
        while True:
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=numbers))
            if numbers[-1] == 0:
                goal_handle.succeed()
                break
            await self.sleep(0.25)
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                break
            if mine != self.generation:
                goal_handle.abort()
                break
            numbers.append(numbers[-1] - 1)
        return Fibonacci.Result(sequence=numbers)


def main():
    rclpy.init()
    node = Countdown()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
