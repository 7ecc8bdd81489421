import rclpy
from my_interfaces import msg, srv
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node


class Publisher(Node):
    def __init__(self):
        super().__init__("level")
        self.message = msg.Reading(sensor="tank", unit="percent", value=0.0)
        self.publisher = self.create_publisher(msg.Reading, "/tank/reading", 1)
        self.create_timer(0.3, self.send)

    def send(self):
        self.message.header.stamp = self.get_clock().now().to_msg()
        self.message.value = 50.0 if self.message.value else 100.0
        self.publisher.publish(self.message)


class Answerer(Node):
    def __init__(self):
        super().__init__("ranges")
        self.create_service(srv.InRange, "/tank/in_range", self.answer)

    @staticmethod
    def answer(request, response):
        response.inside = all((request.value >= request.low, request.value <= request.high))
        return response


def main(args=None):
    rclpy.init(args=args)
    executor = SingleThreadedExecutor()
    for node in (Publisher(), Answerer()):
        executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
