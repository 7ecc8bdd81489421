import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


def main():
    rclpy.init()
    node = Node("calculator_client")
    clients = [node.create_client(AddTwoInts, name) for name in ("add", "subtract", "multiply", "divide")]
    while not clients[0].wait_for_service(timeout_sec=0.2):
        node.get_logger().info("waiting for the calculator")
    futures = [client.call_async(AddTwoInts.Request(a=100, b=-5)) for client in clients]
    for client, future in zip(clients, futures):
        rclpy.spin_until_future_complete(node, future)
        node.get_logger().info(f"{client.srv_name}: {future.result().sum}")
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
