#!/usr/bin/env python3

"""
Calculator services add, subtract, multiply, divide on AddTwoInts.
Divide by zero gives 0 and a error in the log.
"""


import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

class Calculator(Node):
    def __init__(self):

        super().__init__('calculator')
        self.add=self.create_service(AddTwoInts,'/add',self.add_cb)
        self.sub=self.create_service(AddTwoInts,'/subtract',self.sub_cb)
        self.mul=self.create_service(AddTwoInts,'/multiply',self.mul_cb)
        self.div=self.create_service(AddTwoInts,'/divide',self.div_cb)
        print('Calculator is up')


    def add_cb(self,req,res):
        res.sum=req.a+req.b
        self.get_logger().info(f'add {req.a} {req.b} : {res.sum}')
        return res

    def sub_cb(self,req,res):
        res.sum=req.a-req.b
        self.get_logger().info(f'sub {req.a} {req.b} : {res.sum}')
        return res

    def mul_cb(self,req,res):
        res.sum=req.a*req.b
        self.get_logger().info(f'mul {req.a} {req.b} : {res.sum}')
        return res

    def div_cb(self,req,res):
        try:
            res.sum=req.a//req.b
            self.get_logger().info(f'div {req.a} {req.b} : {res.sum}')
        except ZeroDivisionError:
            res.sum=0
            self.get_logger().error(f'div {req.a} {req.b} : cannot divide by zero')
        return res


def main():
    rclpy.init()
    node=Calculator()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()

if __name__=='__main__':
    main()
