import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


def ask_harbour(up):
    helper = rclpy.create_node("harbour_helper")
    executor = SingleThreadedExecutor()
    executor.add_node(helper)
    try:
        client = helper.create_client(SetBool, "/harbour/clearance")
        if not client.wait_for_service(timeout_sec=2.0):
            return False, "harbour not found"
        future = client.call_async(SetBool.Request(data=up))
        executor.spin_until_future_complete(future, timeout_sec=3.0)
        if not future.done():
            return False, "harbour did not reply"
        return future.result().success, future.result().message
    finally:
        executor.shutdown()
        helper.destroy_node()


class BridgeKeeper(Node):
    def __init__(self):
        super().__init__("bridge_keeper")
        self.create_service(SetBool, "/bridge/move", self.move, callback_group=ReentrantCallbackGroup())
        self.pub = self.create_publisher(Bool, "/bridge/light", 10)
        self.create_timer(0.1, self.tick)

    def tick(self):
        self.pub.publish(Bool(data=True))

    def move(self, request, response):
        response.success, response.message = ask_harbour(request.data)
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


if __name__ == "__main__":
    main()
