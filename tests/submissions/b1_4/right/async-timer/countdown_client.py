"""The client as one coroutine, run as a task of the executor."""
import sys

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor


async def ask(client):
    goal = await client.send_goal_async(
        Fibonacci.Goal(order=3), feedback_callback=lambda m: print("now", m.feedback.sequence[-1])
    )
    if not goal.accepted:
        return None
    return (await goal.get_result_async()).result


def main():
    rclpy.init()
    node = rclpy.create_node("asker")
    client = ActionClient(node, Fibonacci, "/countdown")
    while not client.wait_for_server(1.0):
        print("waiting for the server")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    task = executor.create_task(ask, client)
    executor.spin_until_future_complete(task)
    result = task.result()
    rclpy.shutdown()
    if result is None:
        sys.exit("the server does not want to")
    print("done:", *result.sequence)


main()
