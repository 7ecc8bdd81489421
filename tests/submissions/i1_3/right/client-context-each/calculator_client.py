import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from example_interfaces.srv import AddTwoInts
def call(op, a, b):
    ctx = Context(); ctx.init()
    n = rclpy.create_node('client_' + op, context=ctx)
    ex = SingleThreadedExecutor(context=ctx); ex.add_node(n)
    c = n.create_client(AddTwoInts, op)
    assert c.wait_for_service(timeout_sec=10)
    f = c.call_async(AddTwoInts.Request(a=a, b=b))
    ex.spin_until_future_complete(f)
    r = f.result().sum
    n.destroy_node(); ctx.shutdown()
    return r
for op in ('add','subtract','multiply','divide'):
    print(op, call(op, 30, -6))
