from itertools import cycle

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


def run(node):
    harbour = node.create_client(SetBool, "/harbour/clearance", callback_group=ReentrantCallbackGroup())
    light = node.create_publisher(Bool, "/bridge/light", 10)
    states = cycle((True, False))

    async def ask_with_limit(request, seconds):
        future = harbour.call_async(request)
        limit = node.create_timer(seconds, future.cancel, callback_group=ReentrantCallbackGroup())
        try:
            return await future
        finally:
            limit.cancel()

    async def move(request, response):
        if not harbour.service_is_ready():
            return SetBool.Response(success=False, message="no harbour")
        reply = await ask_with_limit(request, 3)
        return reply or SetBool.Response(success=False, message="harbour silent")

    node.create_service(SetBool, "/bridge/move", move, callback_group=ReentrantCallbackGroup())
    node.create_timer(0.1, lambda: light.publish(Bool(data=next(states))))
    rclpy.spin(node)


if __name__ == "__main__":
    rclpy.init()
    try:
        run(rclpy.create_node("bridge_keeper"))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
