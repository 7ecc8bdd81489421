import rclpy as rp
from example_interfaces.srv import AddTwoInts

rp.init()
test_node = rp.create_node('client_test')

req = AddTwoInts.Request()
req.a = 24
req.b = 6

for service_name in ['add', 'subtract', 'multiply', 'divide']:
    cli = test_node.create_client(AddTwoInts, service_name)
    while not cli.wait_for_service(timeout_sec=1.0):
        print('Waiting for service...')
    future = cli.call_async(req)
    while not future.done():
        rp.spin_once(test_node)
        print(future.done(), future.result())
    print(service_name, req.a, req.b, '->', future.result().sum)

test_node.destroy_node()
rp.shutdown()
