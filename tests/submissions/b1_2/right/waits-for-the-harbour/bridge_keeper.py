import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class BridgeKeeper(Node):
    def __init__(self):
        super().__init__("bridge_keeper")
        group = ReentrantCallbackGroup()
        self.client = self.create_client(SetBool, "/harbour/clearance", callback_group=group)
        self.create_service(SetBool, "/bridge/move", self.on_move, callback_group=group)
        self.light = self.create_publisher(Bool, "/bridge/light", 10)
        self.create_timer(0.1, self.on_light)

    def on_light(self):
        self.light.publish(Bool(data=True))

    async def sleep(self, seconds):
        over = Future()
        timer = self.create_timer(seconds, lambda: over.set_result(None))
        await over
        self.destroy_timer(timer)

    async def harbour_is_there(self):
        for _ in range(10):
            if self.client.service_is_ready():
                return True
            await self.sleep(0.2)
        return False

    async def on_move(self, request, response):
        if not await self.harbour_is_there():
            response.message = "I waited two seconds for the harbour"
            return response
        asked = self.client.call_async(SetBool.Request(data=request.data))
        for _ in range(60):
            if asked.done():
                response.success = asked.result().success
                response.message = asked.result().message
                return response
            await self.sleep(0.05)
        response.message = "no reply"
        return response


def main():
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
