"""Ask the calc brain one of everything."""
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

ASK = [('/add', 2, 3), ('/subtract', 2, 3), ('/multiply', 2, 3), ('/divide', 6, 3)]

rclpy.init(); nd = Node('calc_asker')
for srv, a, b in ASK:
    cli = nd.create_client(AddTwoInts, srv)
    while not cli.wait_for_service(timeout_sec=1.0): print(f'... {srv}')
    q = AddTwoInts.Request(); q.a = a; q.b = b
    f = cli.call_async(q); rclpy.spin_until_future_complete(nd, f)
    print(f'{srv} {a} {b} -> {f.result().sum}')
nd.destroy_node(); rclpy.shutdown()
