#!/usr/bin/env python3
"""Calls /slow_add three times at once, says how long each answer took, then ends."""

import sys
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

CALLS = ((5, 1), (5, 2), (5, 3))
WAIT_S = 5.0
ANSWERS_WITHIN_S = 15.0


class SlowAddCallers(Node):
    """Three callers in one: asks for three sums without waiting for the first."""

    def __init__(self) -> None:
        super().__init__("slow_add_callers")
        self.waited_for = self.create_client(AddTwoInts, "slow_add")

    def run(self) -> bool:
        """Make all calls. Return whether every call was answered."""
        log = self.get_logger()
        if not self.waited_for.wait_for_service(timeout_sec=WAIT_S):
            log.error("There is no service /slow_add: is your node running?")
            return False
        began = time.monotonic()
        waiting = {self.waited_for.call_async(AddTwoInts.Request(a=a, b=b)): (a, b) for a, b in CALLS}
        log.info(f"Called /slow_add {len(CALLS)} times at once")
        while waiting and time.monotonic() < began + ANSWERS_WITHIN_S:
            rclpy.spin_once(self, timeout_sec=0.1)
            for future in [each for each in waiting if each.done()]:
                a, b = waiting.pop(future)
                log.info(f"{a} + {b} = {future.result().sum}, answered after {time.monotonic() - began:.1f} s")
        for a, b in waiting.values():
            log.error(f"{a} + {b} was not answered within {ANSWERS_WITHIN_S:.0f} s")
        return not waiting


def main() -> None:
    """Run the calls once: exit code 0 if all were answered, 1 if not."""
    rclpy.init()
    node = SlowAddCallers()
    done = False
    try:
        done = node.run()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # Ctrl+C: not an error worth a traceback, but not done either.
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    if not done:
        sys.exit(1)


if __name__ == "__main__":
    main()
