import asyncio
import threading

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException


def spin(node):
    try:
        rclpy.spin(node)
    except ExternalShutdownException:
        pass


async def answer_of(future):
    """Let asyncio wait for a future of rclpy."""
    answered = asyncio.Event()
    future.add_done_callback(lambda _: answered.set())
    while not future.done():
        try:
            await asyncio.wait_for(answered.wait(), timeout=4.5)
        except TimeoutError:
            pass  # look again
    return future.result()


async def calculate(node, a, b):
    for name in ('add', 'subtract', 'multiply', 'divide'):
        client = node.create_client(AddTwoInts, name)
        while not client.service_is_ready():
            await asyncio.sleep(0.1)
        result = await answer_of(client.call_async(AddTwoInts.Request(a=a, b=b)))
        print(f'{name}({a}, {b}) = {result.sum}')


def main():
    rclpy.init()
    node = rclpy.create_node('calculator_client')
    threading.Thread(target=spin, args=(node,), daemon=True).start()
    try:
        asyncio.run(calculate(node, 12, 4))
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
