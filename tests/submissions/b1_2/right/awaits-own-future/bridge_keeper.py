import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class Keeper(Node):
    def __init__(self):
        super().__init__("bridge_keeper", namespace="bridge")
        self.group = ReentrantCallbackGroup()
        self.office = self.create_client(SetBool, "/harbour/clearance", callback_group=self.group)
        self.create_service(SetBool, "move", self.on_move, callback_group=self.group)
        self.lamp = self.create_publisher(Bool, "light", 1)
        self.blinker = self.create_timer(1 / 10, lambda: self.lamp.publish(Bool(data=True)), callback_group=self.group)

    def ask(self, up):
        decision = Future()
        watchdog = None

        def decide(success, message):
            if not decision.done():
                decision.set_result((success, message))
            if watchdog is not None:
                self.destroy_timer(watchdog)

        if not self.office.service_is_ready():
            decide(False, "the office is closed")
            return decision
        request = SetBool.Request()
        request.data = up
        sent = self.office.call_async(request)
        sent.add_done_callback(lambda done: decide(done.result().success, done.result().message))

        def give_up():
            self.office.remove_pending_request(sent)
            decide(False, "the office does not reply")

        watchdog = self.create_timer(3.0, give_up, callback_group=self.group)
        return decision

    async def on_move(self, request, response):
        response.success, response.message = await self.ask(request.data)
        return response


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    executor.add_node(Keeper())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


main()
