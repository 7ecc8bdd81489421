import rclpy
from rclpy.node import Node 
from example_interfaces.srv import AddTwoInts
#import RPi.GPIO as g

class Calc_server(Node):
    def __init__(self):
        super().__init__('calcServer')
        self.srv1 = self.create_service(AddTwoInts, 'add', self.plus)
        self.srv2 = self.create_service(AddTwoInts, 'subtract', self.minus)
        self.srv3 = self.create_service(AddTwoInts, 'multiply', self.mal)
        self.srv4 = self.create_service(AddTwoInts, 'divide', self.geteilt)
        #g.setmode(g.BCM)
        #g.setup(21, g.OUT)

    def plus(self, request, response):
        self.get_logger().info(f'incomming data {request.a} {request.b}')
        response.sum = request.a + request.b
        return response

    def minus(self, request, response):
        self.get_logger().info(f'incomming data {request.a} {request.b}')
        response.sum = request.a - request.b
        return response

    def mal(self, request, response):
        self.get_logger().info(f'incomming data {request.a} {request.b}')
        response.sum = request.a * request.b
        return response

    def geteilt(self, request, response):
        self.get_logger().info(f'incomming data {request.a} {request.b}')
        if request.b != 0:
            response.sum = request.a // request.b
        else:
            response.success = False
            response.message = 'division by zero'
        return response

def main(args = None):
    rclpy.init(args = args)
    node = Calc_server()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        #g.cleanup()
        node.destroy_node()

if __name__ == '__main__':
    main()
