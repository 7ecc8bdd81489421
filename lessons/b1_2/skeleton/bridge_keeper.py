#!/usr/bin/env python3
"""Exercise B1.2: a service that asks another one before it answers.

Meanwhile, a warning light in the same node must go on blinking.
"""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class BridgeKeeper(Node):
    """Moves a drawbridge, once the harbour allows it."""

    def __init__(self) -> None:
        super().__init__("bridge_keeper")
        self.lit = False
        self.light = self.create_publisher(Bool, "/bridge/light", 10)
        self.create_timer(0.1, self.blink)
        self.create_service(SetBool, "/bridge/move", self.move)
        # TODO 1: create a client of /harbour/clearance, which is a
        #         SetBool as well.

        # TODO 2: say which callbacks may run while another one waits.

        self.get_logger().info("Ready: /bridge/move")

    def move(
        self,
        request: SetBool.Request,
        response: SetBool.Response,
    ) -> SetBool.Response:
        """Say whether the bridge moves: up if request.data is true."""
        # TODO 3: if the harbour is not there, say so: answer with
        #         success = False and a message that says why.

        # TODO 4: ask the harbour with the same data, wait for its
        #         reply, and answer with its success and message.
        response.success = True
        response.message = "nobody was asked"
        return response

    def blink(self) -> None:
        """Switch the light. This part is complete."""
        self.lit = not self.lit
        self.light.publish(Bool(data=self.lit))


def main() -> None:
    """Run the node until Ctrl+C. You may give it more threads."""
    rclpy.init()
    node = BridgeKeeper()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
