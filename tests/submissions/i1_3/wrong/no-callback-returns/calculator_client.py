# Copyright (c) 2023. Port of calculator_service_client.cpp to Python.
import sys

import rclpy
import rclpy.node
from example_interfaces.srv import AddTwoInts


def main(argc, argv):
    rclpy.init(args=argv)

    node = rclpy.node.Node("calculator_service_client")
    clients_ = [
        node.create_client(AddTwoInts, "/add"),
        node.create_client(AddTwoInts, "/subtract"),
        node.create_client(AddTwoInts, "/multiply"),
        node.create_client(AddTwoInts, "/divide"),
    ]

    for client in clients_:
        while not client.wait_for_service(timeout_sec=1.0):
            if not rclpy.ok():
                node.get_logger().error("Interrupted while waiting for the service. Exiting.")
                return 0
            node.get_logger().info("service not available, waiting again...")

        request = AddTwoInts.Request()
        request.a = 36
        request.b = 12
        result = client.call_async(request)
        # Wait for the result.
        rclpy.spin_until_future_complete(node, result)
        if result.result() is not None:
            node.get_logger().info("%s: %d" % (client.srv_name, result.result().sum))
        else:
            node.get_logger().error("Failed to call service %s" % client.srv_name)

    rclpy.shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main(len(sys.argv), sys.argv))
