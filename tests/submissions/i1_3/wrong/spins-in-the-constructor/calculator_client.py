#!/usr/bin/env python3

import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class MyROSClass(Node):

    def __init__(self):
        super().__init__('service_client_node')

    def call_service(self, topic, a, b):
        client = self.create_client(AddTwoInts, topic)
        while client.wait_for_service(timeout_sec=1.0) == False:
            self.get_logger().warn("servis bekleniyor: " + topic)

        request = AddTwoInts.Request()
        request.a = a
        request.b = b
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        self.get_logger().info(topic + " sonuc: " + str(future.result().sum))


def main():
    rclpy.init()
    node = MyROSClass()
    node.call_service("/add", 8, 4)
    node.call_service("/subtract", 8, 4)
    node.call_service("/multiply", 8, 4)
    node.call_service("/divide", 8, 4)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
