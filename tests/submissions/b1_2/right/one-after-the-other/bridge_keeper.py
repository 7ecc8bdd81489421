import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class BridgeKeeper(Node):
    def __init__(self):
        super().__init__("bridge_keeper")
        self.light_publisher = self.create_publisher(Bool, "/bridge/light", 10)
        self.light_timer = self.create_timer(0.1, self.publish_light)
        self.clearance = self.create_client(SetBool, "/harbour/clearance")
        self.move_service = self.create_service(
            SetBool, "/bridge/move", self.move, callback_group=MutuallyExclusiveCallbackGroup()
        )
        self.light_on = False

    def publish_light(self):
        self.light_on ^= True
        self.light_publisher.publish(Bool(data=self.light_on))

    async def move(self, request, response):
        if self.clearance.service_is_ready():
            self.get_logger().info("Asking")
            return await self.clearance.call_async(request)
        response.success = False
        response.message = "The harbour is closed."
        return response


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(BridgeKeeper())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
