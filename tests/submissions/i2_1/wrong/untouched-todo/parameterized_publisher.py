import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        # TODO: declare the parameters
        pass


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
