import threading

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class BridgeKeeper(Node):
    def __init__(self):
        super().__init__("bridge_keeper")
        self.lit = False
        self.light = self.create_publisher(Bool, "/bridge/light", 10)
        self.create_timer(0.1, self.blink)
        self.cb_group = ReentrantCallbackGroup()
        self.cli = self.create_client(SetBool, "/harbour/clearance", callback_group=self.cb_group)
        self.srv = self.create_service(SetBool, "/bridge/move", self.move, callback_group=self.cb_group)

    def move(self, request, response):
        response.success = False
        if not self.cli.service_is_ready():
            response.message = "no harbour"
            return response
        self.event = threading.Event()
        future = self.cli.call_async(SetBool.Request(data=request.data))
        future.add_done_callback(self.replied)
        if not self.event.wait(timeout=3.0):
            self.cli.remove_pending_request(future)
            response.message = "harbour does not answer"
            return response
        result = self.result
        response.success = result.success
        response.message = result.message
        return response

    def replied(self, future):
        self.result = future.result()
        self.event.set()

    def blink(self):
        self.lit = not self.lit
        self.light.publish(Bool(data=self.lit))


def main(args=None):
    rclpy.init(args=args)
    node = BridgeKeeper()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown(timeout_sec=1.0)
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
