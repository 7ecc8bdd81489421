import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class BridgeKeeper(Node):
    def __init__(self):
        super().__init__('bridge_keeper')
        self.services_group = ReentrantCallbackGroup()
        self.client_group = MutuallyExclusiveCallbackGroup()
        self.timer_group = MutuallyExclusiveCallbackGroup()
        self.client = self.create_client(SetBool, '/harbour/clearance', callback_group=self.client_group)
        self.srv = self.create_service(SetBool, '/bridge/move', self.on_move, callback_group=self.services_group)
        self.pub = self.create_publisher(Bool, '/bridge/light', 10)
        self.timer = self.create_timer(0.1, self.on_timer, callback_group=self.timer_group)
        self.on = False

    def on_timer(self):
        self.on = not self.on
        self.pub.publish(Bool(data=self.on))

    def on_move(self, request, response):
        if not self.client.wait_for_service(timeout_sec=1.0):
            response.success = False
            response.message = 'harbour not available'
            return response
        result = self.client.call(SetBool.Request(data=request.data), timeout_sec=3.0)
        if result is None:
            response.success = False
            response.message = 'harbour timed out'
            return response
        response.success = result.success
        response.message = result.message
        return response


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
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
