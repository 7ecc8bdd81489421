#!/usr/bin/env python3
# ported from the noetic workspace (slow_add_server.py), rospy calls replaced by the
# small functions below so that the rest of the file could stay as it was

import sys
import time

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from example_interfaces.srv import AddTwoInts

_node = None
_logger = None
_executor = None


def init_node(node_name):
    global _node, _logger, _executor
    rclpy.init(args=sys.argv)
    _node = rclpy.create_node(node_name)
    _logger = _node.get_logger()
    _executor = MultiThreadedExecutor(num_threads=8)
    _executor.add_node(_node)


def loginfo(log_text, *args):
    _logger.info(log_text % args)


def Service(name, service_class, handler):
    return _node.create_service(service_class, name, handler,
                                callback_group=ReentrantCallbackGroup())


def Timer(period, callback):
    return _node.create_timer(period, callback, callback_group=ReentrantCallbackGroup())


def spin():
    try:
        _executor.spin()
    except KeyboardInterrupt:
        loginfo('shutting down')
    finally:
        _node.destroy_node()
        rclpy.shutdown()


# ---------------------------------------------------------------------------

# shared between the handler and the helper, as in the old node
state = {
    'a': 0,
    'b': 0,
    'ticks': 0,
}


def compute():
    time.sleep(3.0)
    return state['a'] + state['b']


def handle_slow_add(req, resp):
    state['a'] = req.a
    state['b'] = req.b
    loginfo('slow_add: %d + %d', req.a, req.b)
    resp.sum = compute()
    return resp


def on_timer():
    state['ticks'] += 1
    if state['ticks'] % 10 == 0:
        loginfo('tick %d', state['ticks'])


def slow_add_server():
    init_node('concurrent_service')
    s = Service('slow_add', AddTwoInts, handle_slow_add)
    t = Timer(0.1, on_timer)
    loginfo('Ready to add two ints, slowly.')
    spin()


if __name__ == '__main__':
    slow_add_server()
