import rclpy as rp
from example_interfaces.srv import AddTwoInts

# notebook version was: Service Client test.ipynb  -> turned into a script

rp.init()
test_node = rp.create_node('calc_test')


def add(request, response):
    response.sum = request.a + request.b
    print('add', request, response)
    return response


def subtract(request, response):
    response.sum = request.a - request.b
    print('subtract', request, response)
    return response


def multiply(request, response):
    response.sum = request.a * request.b
    print('multiply', request, response)
    return response


def divide(request, response):
    if request.b != 0:
        response.sum = request.a // request.b
    else:
        response.sum = 0
        test_node.get_logger().error('b is 0, can not divide')
    print('divide', request, response)
    return response


test_node.create_service(AddTwoInts, 'add', add)
test_node.create_service(AddTwoInts, 'subtract', subtract)
test_node.create_service(AddTwoInts, 'multiply', multiply)
test_node.create_service(AddTwoInts, 'divide', divide)

try:
    rp.spin_once(test_node)
except KeyboardInterrupt:
    pass

test_node.destroy_node()
rp.try_shutdown()
