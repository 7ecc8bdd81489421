import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from example_interfaces.srv import AddTwoInts


class Calc(Node):
    def __init__(self):
        super().__init__("calculator_server")
        self.create_service(AddTwoInts, "add", self.add)
        self.create_service(AddTwoInts, "subtract", self.subtract)
        self.create_service(AddTwoInts, "multiply", self.multiply)
        self.create_service(AddTwoInts, "divide", self.divide)

    def add(self, q, r):
        r.sum = q.a + q.b
        return r

    def subtract(self, q, r):
        r.sum = q.a - q.b
        return r

    def multiply(self, q, r):
        r.sum = q.a * q.b
        return r

    def divide(self, q, r):
        if q.b == 0:
            self.get_logger().error("division by zero")
            r.sum = 0
            return r
        r.sum = q.a // q.b
        return r


def main():
    rclpy.init()
    n = Calc()
    try:
        rclpy.spin(n)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        n.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
