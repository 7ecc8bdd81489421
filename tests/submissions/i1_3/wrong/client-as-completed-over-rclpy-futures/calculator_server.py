"""Calculator tool server for the voice assistant."""

import logging
import operator

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

TOOLS = {
    'add': operator.add,
    'subtract': operator.sub,
    'multiply': operator.mul,
    'divide': operator.floordiv,
}


class ToolServer(Node):

    def __init__(self):
        super().__init__('calculator_server')
        for tool_name in TOOLS:
            self._register(tool_name)
        self.get_logger().info('Registered tools: ' + ', '.join(TOOLS))

    def _register(self, tool_name):
        async def handle(request, response):
            response.sum = await self._run_tool(tool_name, request.a, request.b)
            return response
        self.create_service(AddTwoInts, tool_name, handle)

    async def _run_tool(self, tool_name, a, b):
        try:
            return TOOLS[tool_name](a, b)
        except ArithmeticError as e:
            self.get_logger().error('Tool %s failed for (%d, %d): %s' % (tool_name, a, b, e))
            return 0


def main():
    rclpy.init()
    node = ToolServer()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        logging.info('bye')
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
