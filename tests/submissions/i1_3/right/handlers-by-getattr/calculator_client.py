#!/usr/bin/env python3
"""Each "button" of the calculator panel is a node of its own (as in our ROV GUI), pressed here by a script."""
import re
import sys
from threading import Thread
from typing import Any, Callable

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

TIMEOUT_SEC: float = 5.0


class EventClient(Node):
    """Client for one service; the request is sent from a worker thread with an executor of its own."""

    def __init__(self, srv_type: Any, topic: str, signal: Callable[[int, int, Any], None]) -> None:
        node_name = f'client_{re.sub(r"[^a-zA-Z0-9_]", "_", topic.strip("/"))}'
        super().__init__(node_name)
        self.topic = topic
        self.signal = signal
        self.cli = self.create_client(srv_type, topic)

    def send_request_async(self, request: Any) -> Thread:
        worker = Thread(target=self._send, args=[request], daemon=True)
        worker.start()
        return worker

    def _send(self, request: Any) -> None:
        while not self.cli.wait_for_service(timeout_sec=TIMEOUT_SEC):
            self.get_logger().warning(f'{self.topic} unavailable, waiting again...')

        executor = SingleThreadedExecutor()
        executor.add_node(self)
        future = self.cli.call_async(request)
        executor.spin_until_future_complete(future, timeout_sec=TIMEOUT_SEC)
        executor.remove_node(self)
        self.signal(request.a, request.b, future.result())


class Panel:
    """What would be the Qt widget."""

    def __init__(self) -> None:
        self.shown: list[str] = []
        self.buttons = {
            sign: EventClient(AddTwoInts, topic, self._slot_for(sign))
            for sign, topic in (('+', '/add'), ('-', '/subtract'), ('x', '/multiply'), (':', '/divide'))
        }

    def _slot_for(self, sign: str) -> Callable[[int, int, Any], None]:
        def slot(a: int, b: int, response: Any) -> None:
            if response is None:
                self.buttons[sign].get_logger().error(f'no answer to {a} {sign} {b}')
                return
            line = f'{a} {sign} {b} = {response.sum}'
            self.shown.append(line)
            self.buttons[sign].get_logger().info(line)
        return slot

    def press(self, a: int, sign: str, b: int) -> None:
        self.buttons[sign].send_request_async(AddTwoInts.Request(a=a, b=b)).join()

    def close(self) -> None:
        for button in self.buttons.values():
            button.destroy_node()


def main() -> int:
    rclpy.init()
    panel = Panel()
    script = [(17, '+', 4), (17, '-', 40), (-3, 'x', 9), (84, ':', -7)]
    for a, sign, b in script:
        panel.press(a, sign, b)
    panel.close()
    rclpy.try_shutdown()
    return 0 if len(panel.shown) == len(script) else 1


if __name__ == '__main__':
    sys.exit(main())
