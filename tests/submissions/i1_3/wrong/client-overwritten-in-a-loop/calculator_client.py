#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class ServiceClient02(Node):
    def __init__(self, name):
        super().__init__(name)
        self.get_logger().info("节点已启动：%s!" % name)
        self.ops_ = ["add", "subtract", "multiply", "divide"]
        for op in self.ops_:
            self.client_ = self.create_client(AddTwoInts, op)
            while rclpy.ok() and self.client_.wait_for_service(1) == False:
                self.get_logger().info(f"等待服务端 {op} 上线....")

    def send_request(self, op, a, b):
        request = AddTwoInts.Request()
        request.a = a
        request.b = b
        future = self.client_.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        self.get_logger().info(f"收到返回结果：{op}({a}, {b}) = {future.result().sum}")


def main(args=None):
    rclpy.init(args=args)
    node = ServiceClient02("calculator_client")
    for op in node.ops_:
        node.send_request(op, 12, 4)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
