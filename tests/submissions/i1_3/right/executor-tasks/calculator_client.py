import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class Client(Node):
    def __init__(self):
        super().__init__('calculator_client')
        self.ops = {n: self.create_client(AddTwoInts, n)
                    for n in ('add', 'subtract', 'multiply', 'divide')}

    async def compute(self, name, a, b):
        answer = await self.ops[name].call_async(AddTwoInts.Request(a=a, b=b))
        self.get_logger().info(f'{name} {a} {b} -> {answer.sum}')
        return answer.sum

    async def demo(self):
        # (2 + 3) * 4 - 8, then / 6
        x = await self.compute('add', 2, 3)
        x = await self.compute('multiply', x, 4)
        x = await self.compute('subtract', x, 8)
        return await self.compute('divide', x, 6)


def main():
    rclpy.init()
    client = Client()
    for name, cli in client.ops.items():
        while not cli.wait_for_service(timeout_sec=1.0):
            client.get_logger().info(f'waiting for {name} ...')

    executor = SingleThreadedExecutor()
    executor.add_node(client)
    task = executor.create_task(client.demo)
    executor.spin_until_future_complete(task)
    print('((2 + 3) * 4 - 8) / 6 =', task.result())

    executor.shutdown()
    client.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
