import rclpy
from calculator_server import CalculatorServer
from example_interfaces.srv import AddTwoInts

rclpy.init()
server = CalculatorServer()
for method in (server.add, server.subtract, server.multiply, server.divide):
    print(method(AddTwoInts.Request(a=8, b=2), AddTwoInts.Response()).sum)
rclpy.shutdown()
