#!/usr/bin/env python3
"""Moves a drawbridge once the harbour allows it, while a warning light goes on blinking."""

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

BLINK_S = 0.1
PATIENCE_S = 3.0


class BridgeKeeper(Node):
    """Offers /bridge/move, asks /harbour/clearance before it answers, and blinks on /bridge/light."""

    def __init__(self) -> None:
        super().__init__("bridge_keeper")
        self.lit = False
        self.light = self.create_publisher(Bool, "/bridge/light", 10)
        # The harbour's reply must get in while move() waits for it: so never the same exclusive group.
        self.harbour = self.create_client(
            SetBool, "/harbour/clearance", callback_group=MutuallyExclusiveCallbackGroup()
        )
        # Reentrant: a second request is taken in while the first one waits.
        self.create_service(SetBool, "/bridge/move", self.move, callback_group=ReentrantCallbackGroup())
        self.create_timer(BLINK_S, self.blink)
        self.get_logger().info("Ready: /bridge/move")

    async def move(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        """Ask the harbour, and pass its reply on. `await` leaves the thread to others until the reply is there."""
        if not self.harbour.service_is_ready():
            return self.refuse(response, "There is no harbour")
        asked = self.harbour.call_async(SetBool.Request(data=request.data))
        patience = self.create_timer(PATIENCE_S, asked.cancel)
        reply = await asked  # None if it was cancelled
        self.destroy_timer(patience)
        if reply is None:
            return self.refuse(response, f"The harbour has not replied for {PATIENCE_S:g} s")
        self.get_logger().info(f"{'Raise' if request.data else 'Lower'}: the harbour says {reply.message}")
        response.success, response.message = reply.success, reply.message
        return response

    def refuse(self, response: SetBool.Response, why: str) -> SetBool.Response:
        """Answer that the bridge does not move, and why."""
        self.get_logger().warning(why)
        response.success, response.message = False, why
        return response

    def blink(self) -> None:
        """Switch the light."""
        self.lit = not self.lit
        self.light.publish(Bool(data=self.lit))


def main() -> None:
    """Run the node until Ctrl+C. One thread is enough: no callback keeps it while it waits."""
    rclpy.init()
    node = BridgeKeeper()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C, or someone shut ROS down: both are a normal end.
    finally:
        rclpy.try_shutdown()  # Not shutdown(): after Ctrl+C, rclpy has already shut down.


if __name__ == "__main__":
    main()
