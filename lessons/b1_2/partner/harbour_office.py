#!/usr/bin/env python3
"""Serves /harbour/clearance: thinks for a moment, then allows the move, or not. Ctrl+C ends it."""

import itertools

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import SetBool

THINKS_S = 1.5
REFUSES_EVERY = 4


class HarbourOffice(Node):
    """Answers each request after 1.5 s, several at once, with a new number; every fourth one is refused."""

    def __init__(self) -> None:
        super().__init__("harbour_office")
        self.numbers = itertools.count(101)
        self.create_service(SetBool, "/harbour/clearance", self.clear, callback_group=ReentrantCallbackGroup())
        self.get_logger().info("Ready: /harbour/clearance")

    async def clear(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        """Think, then answer."""
        number, move = next(self.numbers), "raise" if request.data else "lower"
        self.get_logger().info(f"Request {number}: may the keeper {move} the bridge? Thinking for {THINKS_S:g} s")
        await self.think()
        response.success = number % REFUSES_EVERY != 0
        response.message = f"clearance {number} to {move}" if response.success else f"no {number}: a ship is coming"
        self.get_logger().info(f"Reply to {number}: {response.message}")
        return response

    async def think(self) -> None:
        """Return after a while, without blocking the thread."""
        thought = Future()
        timer = self.create_timer(THINKS_S, lambda: thought.set_result(None))
        await thought
        self.destroy_timer(timer)


def main() -> None:
    """Run the office until Ctrl+C."""
    rclpy.init()
    node = HarbourOffice()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
