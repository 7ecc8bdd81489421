import rclpy
from rclpy.executors import ExternalShutdownException
from example_interfaces.srv import AddTwoInts
from ops import Op

def logged(node, op):
    def wrapper(req, res):
        try:
            res.sum = op(req.a, req.b)
        except ArithmeticError as err:
            node.get_logger().error('%s(%d, %d): %s' % (op.value, req.a, req.b, err))
            res.sum = -(2 ** 63)
        else:
            node.get_logger().info('%s(%d, %d) = %d' % (op.value, req.a, req.b, res.sum))
        return res
    return wrapper

def main():
    rclpy.init()
    node = rclpy.create_node('calculator')
    services = [node.create_service(AddTwoInts, op.value, logged(node, op)) for op in Op]
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        node.get_logger().info('Feierabend')
    finally:
        for s in services:
            node.destroy_service(s)
        node.destroy_node()
        rclpy.try_shutdown()
if __name__ == '__main__':
    main()
