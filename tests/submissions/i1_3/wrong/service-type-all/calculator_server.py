import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_srvs.srv import SetBool


class CalculatorServer(Node):
    def __init__(self):
        super().__init__('calculator_server')
        for name in ('add', 'subtract', 'multiply', 'divide'):
            self.create_service(SetBool, name, self.callback)

    def callback(self, req, resp):
        resp.success = True
        resp.message = 'done'
        return resp


def main():
    rclpy.init()
    try:
        rclpy.spin(CalculatorServer())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
