import threading

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup as Exclusive
from rclpy.callback_groups import ReentrantCallbackGroup as Reentrant
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class BridgeKeeper(Node):
    def __init__(self) -> None:
        super().__init__("bridge_keeper")
        self.harbour = self.create_client(SetBool, "/harbour/clearance", callback_group=Reentrant())
        self.create_service(SetBool, "/bridge/move", self.move, callback_group=Reentrant())
        self.light = self.create_publisher(Bool, "/bridge/light", 10)
        self.create_timer(0.1, self.blink, callback_group=Exclusive())

    def blink(self) -> None:
        self.light.publish(Bool(data=True))

    def move(self, request, response):
        replied = threading.Event()
        if not self.harbour.service_is_ready():
            response.message = "nobody there"
            return response
        future = self.harbour.call_async(request)
        future.add_done_callback(lambda _: replied.set())
        if replied.wait(timeout=3):
            return future.result()
        response.message = "no reply within 3 s"
        return response


def main() -> None:
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=8)
    executor.add_node(BridgeKeeper())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
