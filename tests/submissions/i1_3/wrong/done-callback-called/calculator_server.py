import threading
import time
import signal

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from example_interfaces.srv import AddTwoInts

log = None        # set in main
running = True


def add(request, response):
    response.sum = request.a + request.b
    log.info('add %d %d' % (request.a, request.b))
    return response


def subtract(request, response):
    response.sum = request.a - request.b
    log.info('subtract %d %d' % (request.a, request.b))
    return response


def multiply(request, response):
    response.sum = request.a * request.b
    log.info('multiply %d %d' % (request.a, request.b))
    return response


def divide(request, response):
    # never let it crash
    if request.b == 0:
        log.warn('someone tried to divide %d by zero, that is an error!' % request.a)
        response.sum = 0
    else:
        response.sum = request.a // request.b
        log.info('divide %d %d' % (request.a, request.b))
    return response


def main():
    global log, running

    def signal_handler(sig, frame):
        global running
        running = False

    rclpy.init(args=None, signal_handler_options=SignalHandlerOptions.NO)
    calc = Node('calculator_lab')
    log = calc.get_logger()
    for f in (add, subtract, multiply, divide):
        calc.create_service(AddTwoInts, f.__name__, f)

    signal.signal(signal.SIGINT, signal_handler)
    thread = threading.Thread(target=rclpy.spin, args=(calc,), daemon=True)
    thread.start()

    while running:
        time.sleep(0.1)

    rclpy.try_shutdown()
    thread.join(timeout=1.0)


# Check if the node is executing in the main path
if __name__ == '__main__':
    main()
