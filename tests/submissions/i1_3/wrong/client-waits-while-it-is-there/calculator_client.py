#!/usr/bin/env python3

"""
This script calls the four calculator services once.
"""


import time
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

class CalculatorCall(Node):
    def __init__(self):

        super().__init__('calculator_call')
        self.add=self.create_client(AddTwoInts,'/add')
        self.sub=self.create_client(AddTwoInts,'/subtract')
        self.mul=self.create_client(AddTwoInts,'/multiply')
        self.div=self.create_client(AddTwoInts,'/divide')


    def call_service(self,client,a,b):
        while client.wait_for_service(1.0):
            self.get_logger().info(f'waiting for {client.srv_name} seervice ')
            time.sleep(0.5)

        req=AddTwoInts.Request()
        req.a=a
        req.b=b
        future=client.call_async(req)
        rclpy.spin_until_future_complete(self,future)
        print(f'{client.srv_name} {a} {b} : {future.result().sum}')


def main():
    rclpy.init()
    node=CalculatorCall()
    node.call_service(node.add,9,3)
    node.call_service(node.sub,9,3)
    node.call_service(node.mul,9,3)
    node.call_service(node.div,9,3)
    node.destroy_node()
    rclpy.shutdown()

if __name__=='__main__':
    main()
