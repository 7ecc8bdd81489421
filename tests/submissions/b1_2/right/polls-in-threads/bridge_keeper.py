import time

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class BridgeKeeper(Node):
    def __init__(self):
        super().__init__('bridge_keeper')
        cb = ReentrantCallbackGroup()
        self.cli = self.create_client(SetBool, '/harbour/clearance', callback_group=cb)
        self.srv = self.create_service(SetBool, '/bridge/move', self.move_cb, callback_group=cb)
        self.pub = self.create_publisher(Bool, '/bridge/light', 10)
        self.tmr = self.create_timer(0.1, self.light_cb, callback_group=cb)
        self.state = False

    def light_cb(self):
        msg = Bool()
        msg.data = self.state
        self.state = not self.state
        self.pub.publish(msg)

    def move_cb(self, request, response):
        deadline = time.time() + 3.0
        if not self.cli.service_is_ready():
            response.success = False
            response.message = 'No harbour service'
            return response
        future = self.cli.call_async(request)
        while rclpy.ok() and not future.done():
            if time.time() > deadline:
                response.success = False
                response.message = 'Timeout'
                return response
            time.sleep(0.02)
        if future.done():
            response.success = future.result().success
            response.message = future.result().message
        return response


def main():
    rclpy.init()
    node = BridgeKeeper()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
