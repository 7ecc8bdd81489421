import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class VoiceClient(Node):
    def __init__(self):
        super().__init__("voice_client")

    async def ask(self, name, a, b):
        client = self.create_client(AddTwoInts, name)
        while not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info(f"waiting for {name}")
        answer = await client.call_async(AddTwoInts.Request(a=a, b=b))
        self.get_logger().info(f"{name} {a} {b}: {answer.sum}")

    async def dialogue(self):
        await self.ask("add", 1, 2)
        await self.ask("subtract", 1, 2)
        await self.ask("multiply", 3, 2)
        await self.ask("divide", 8, 2)
        await self.ask("divide", 8, 0)


def main(args=None):
    rclpy.init(args=args)
    node = VoiceClient()
    executor = rclpy.get_global_executor()
    executor.add_node(node)
    task = executor.create_task(node.dialogue)
    executor.spin_until_future_complete(task)
    executor.remove_node(node)
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
