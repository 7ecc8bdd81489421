"""A node for each service; one thread spins them all, a turn each."""

import threading
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import SingleThreadedExecutor

OPERATIONS = ("add", "subtract", "multiply", "divide")


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    nodes = [rclpy.create_node(f"{name}_client") for name in OPERATIONS]
    clients = [node.create_client(AddTwoInts, name) for node, name in zip(nodes, OPERATIONS)]
    for client in clients:
        client.wait_for_service(timeout_sec=10.0)
    done = threading.Event()

    def turns():
        while not done.is_set():
            for node in nodes:
                rclpy.spin_once(node, executor=executor)

    thread = threading.Thread(target=turns)
    thread.start()
    for name, client in zip(OPERATIONS, clients):
        answer = client.call_async(AddTwoInts.Request(a=20, b=4))
        while not answer.done():
            time.sleep(0.02)
        print(f"{name}: {answer.result().sum}")
    done.set()
    thread.join()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
