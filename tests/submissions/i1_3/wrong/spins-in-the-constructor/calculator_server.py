#!/usr/bin/env python3

import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

"""
  @author: Kerem
  @about: hesap makinesi servis sunucusu
"""


# butun dugumlerim bu siniftan turuyor
class MyROSClass(Node):

    def __init__(self, node_name):
        super().__init__(node_name)
        self.node_name = node_name
        self.get_logger().info(self.node_name + " is ready.")
        self.start()

    def start(self):
        try:
            rclpy.spin(self)
        except KeyboardInterrupt:
            pass


class Calculator(MyROSClass):

    def __init__(self):

        super().__init__('calculator_server')

        self.service_topics = ["/add", "/subtract", "/multiply", "/divide"]
        self.service_callbacks = [self.topla, self.cikar, self.carp, self.bol]
        self.my_services = []

        for topic, callback in zip(self.service_topics, self.service_callbacks):
            self.my_services.append(self.create_service(AddTwoInts, topic, callback))

    def topla(self, request, response):
        response.sum = request.a + request.b
        return response

    def cikar(self, request, response):
        response.sum = request.a - request.b
        return response

    def carp(self, request, response):
        response.sum = request.a * request.b
        return response

    def bol(self, request, response):
        if request.b == 0:
            message = "Sifira bolme hatasi! (division by zero)"
            self.get_logger().error(message)
            response.sum = 0
        else:
            response.sum = request.a // request.b
        return response


def main():
    rclpy.init()
    node = Calculator()
    node.destroy_node()


if __name__ == '__main__':
    main()
