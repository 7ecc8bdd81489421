import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class Light:
    def __init__(self, node):
        self.on = True
        self.publisher = node.create_publisher(Bool, "/bridge/light", 10)
        node.create_timer(0.1, self.blink, callback_group=MutuallyExclusiveCallbackGroup())

    def blink(self):
        self.publisher.publish(Bool(data=self.on))
        self.on = not self.on


class Harbour:
    def __init__(self, node):
        self.client = node.create_client(SetBool, "/harbour/clearance", callback_group=ReentrantCallbackGroup())

    def ask(self, request):
        if not self.client.service_is_ready():
            return SetBool.Response(success=False, message="No harbour in sight")
        return self.client.call(request)


class Bridge:
    def __init__(self, node):
        self.light = Light(node)
        self.harbour = Harbour(node)
        node.create_service(SetBool, "/bridge/move", self.move, callback_group=ReentrantCallbackGroup())

    def move(self, request, response):
        return self.harbour.ask(request)


def main():
    rclpy.init()
    node = rclpy.create_node("bridge_keeper")
    Bridge(node)
    executor = MultiThreadedExecutor(num_threads=5)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
