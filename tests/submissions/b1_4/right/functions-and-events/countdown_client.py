import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient


def show(message):
    print(f"feedback: {message.feedback}")


def main():
    rclpy.init()
    node = rclpy.create_node("countdown_client")
    client = ActionClient(node, Fibonacci, "countdown")
    client.wait_for_server()
    future = client.send_goal_async(Fibonacci.Goal(order=2), show)
    while not future.done():
        rclpy.spin_once(node)
    if not future.result().accepted:
        print("the goal was not accepted")
        return
    print("accepted")
    future = future.result().get_result_async()
    while not future.done():
        rclpy.spin_once(node, timeout_sec=0.1)
    print(future.result())


main()
