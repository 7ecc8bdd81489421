import threading

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class HarbourPhone(Node):
    def __init__(self):
        super().__init__("harbour_phone")
        self.client = self.create_client(SetBool, "/harbour/clearance")
        self.executor_of_phone = SingleThreadedExecutor()
        self.executor_of_phone.add_node(self)
        threading.Thread(target=self.answer_phone, daemon=True).start()

    def answer_phone(self):
        try:
            self.executor_of_phone.spin()
        except ExternalShutdownException:
            pass

    def ask(self, up):
        if not self.client.service_is_ready():
            return None
        return self.client.call(SetBool.Request(data=up), timeout_sec=3.0)


class BridgeKeeper(Node):
    def __init__(self, phone):
        super().__init__("bridge_keeper")
        self.phone = phone
        self.create_service(
            SetBool, "/bridge/move", self.move, callback_group=MutuallyExclusiveCallbackGroup()
        )
        self.pub = self.create_publisher(Bool, "/bridge/light", 10)
        self.create_timer(0.1, self.blink)

    def blink(self):
        self.pub.publish(Bool())

    def move(self, request, response):
        reply = self.phone.ask(request.data)
        if reply is None:
            response.message = "nobody answers the phone"
        else:
            response.success = reply.success
            response.message = f"harbour: {reply.message}"
        return response


def main():
    rclpy.init()
    phone = HarbourPhone()
    executor = MultiThreadedExecutor(3)
    executor.add_node(BridgeKeeper(phone))
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
