#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class ServiceServer02(Node):
    def __init__(self, name):
        super().__init__(name)
        self.get_logger().info("节点已启动：%s!" % name)
        # 四个服务
        self.add_server_ = self.create_service(AddTwoInts, "add", self.add_callback)
        self.sub_server_ = self.create_service(AddTwoInts, "subtract", self.sub_callback)
        self.mul_server_ = self.create_service(AddTwoInts, "multiply", self.mul_callback)
        self.div_server_ = self.create_service(AddTwoInts, "divide", self.div_callback)

    def add_callback(self, request, response):
        response.sum = request.a + request.b
        self.get_logger().info(f"收到请求，计算 {request.a} + {request.b}")
        return response

    def sub_callback(self, request, response):
        response.sum = request.a - request.b
        self.get_logger().info(f"收到请求，计算 {request.a} - {request.b}")
        return response

    def mul_callback(self, request, response):
        response.sum = request.a * request.b
        self.get_logger().info(f"收到请求，计算 {request.a} * {request.b}")
        return response

    def div_callback(self, request, response):
        self.get_logger().info(f"收到请求，计算 {request.a} / {request.b}")
        if request.b != 0:
            response.sum = request.a // request.b
        else:
            self.get_logger().error("错误：除数不能为零 (division by zero)")
            response.sum = 0
        return response


def main(args=None):
    rclpy.init(args=args)
    node = ServiceServer02("calculator_server")
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
