import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException

OPS = {
    '/add': lambda a, b: a + b,
    '/subtract': lambda a, b: a - b,
    '/multiply': lambda a, b: a * b,
    '/divide': lambda a, b: int(a / b),
}

rclpy.init()
node = rclpy.create_node('calc')


def handler(op):
    def handle(request, response):
        try:
            response.sum = op(request.a, request.b)
        except ZeroDivisionError as e:
            node.get_logger().warning(str(e))
            response.sum = -1
        return response
    return handle


for name, op in OPS.items():
    node.create_service(AddTwoInts, name, handler(op))

try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
