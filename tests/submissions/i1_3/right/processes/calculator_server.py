import multiprocessing as mp
import rclpy
from rclpy.executors import ExternalShutdownException
from example_interfaces.srv import AddTwoInts

def div(a, b, log):
    if b == 0:
        log.error('cannot divide by zero')
        return 0
    return a // b
OPS = {'add': lambda a, b, l: a + b, 'subtract': lambda a, b, l: a - b, 'multiply': lambda a, b, l: a * b, 'divide': div}

def serve(name):
    rclpy.init()
    node = rclpy.create_node(name + '_server')
    def cb(q, r):
        r.sum = OPS[name](q.a, q.b, node.get_logger())
        return r
    node.create_service(AddTwoInts, name, cb)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()

if __name__ == '__main__':
    ps = [mp.Process(target=serve, args=(n,)) for n in OPS]
    for p in ps: p.start()
    try:
        for p in ps: p.join()
    except KeyboardInterrupt:
        for p in ps: p.join()
