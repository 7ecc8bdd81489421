from threading import Thread
from time import sleep

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node


class Ticker(Node):
    def __init__(self):
        super().__init__("ticker")
        self.tick = 0
        self.create_timer(0.1, self.on_tick)

    def on_tick(self):
        self.tick += 1
        self.get_logger().info(f"tick {self.tick}")


class Adder(Node):
    def __init__(self):
        super().__init__("adder")
        self.create_service(AddTwoInts, "/slow_add", self.add)

    def add(self, request, response):
        sleep(3)
        response.sum = request.a + request.b
        return response


def run(executor):
    try:
        executor.spin()
    except ExternalShutdownException:
        pass


def main():
    rclpy.init()
    threads = []
    for node in (Ticker(), Adder()):
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        threads.append(Thread(target=run, args=(executor,)))
    for thread in threads:
        thread.start()


if __name__ == "__main__":
    main()
