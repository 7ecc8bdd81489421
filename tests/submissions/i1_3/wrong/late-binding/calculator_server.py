import rclpy
from rclpy.executors import ExternalShutdownException
from example_interfaces.srv import AddTwoInts
rclpy.init()
node = rclpy.create_node('calc')
ops = {'add': lambda a, b: a + b, 'subtract': lambda a, b: a - b, 'multiply': lambda a, b: a * b, 'divide': lambda a, b: a // b}
for name in ops:
    def cb(req, res):
        if name == 'divide' and req.b == 0:
            node.get_logger().error('division by zero')
            return res
        res.sum = ops[name](req.a, req.b)
        return res
    node.create_service(AddTwoInts, name, cb)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
