import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node

QUEUE = 10


class Calculate(Node):
    def __init__(self):
        super().__init__("calculator_client")
        self.services_by_name = {
            "add": self.create_client(AddTwoInts, "add", qos_profile=QUEUE),
            "subtract": self.create_client(AddTwoInts, "subtract", qos_profile=QUEUE),
            "multiply": self.create_client(AddTwoInts, "multiply", qos_profile=QUEUE),
            "divide": self.create_client(AddTwoInts, "divide", qos_profile=QUEUE),
        }

    def ask(self, name, a, b):
        client = self.services_by_name[name]
        while not client.wait_for_service(timeout_sec=0.5):
            self.get_logger().info(f"no {name} yet")
        future = client.call_async(AddTwoInts.Request(a=a, b=b))
        rclpy.spin_until_future_complete(self, future)
        return future.result().sum


def main():
    rclpy.init()
    node = Calculate()
    for name in node.services_by_name:
        print(name, node.ask(name, 18, 6))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
