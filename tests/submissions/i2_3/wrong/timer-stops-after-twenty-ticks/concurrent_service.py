import sys
import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.executors import ExternalShutdownException
from example_interfaces.srv import AddTwoInts

MAX_TICKS = 20   # enough to see that it works

rclpy.init(args=sys.argv)
node = rclpy.create_node('concurrent_service')
log = node.get_logger()
g_srv = ReentrantCallbackGroup()
g_tmr = MutuallyExclusiveCallbackGroup()
tick_count = 0
timer = None


def on_tick():
    global tick_count
    tick_count += 1
    log.info(f'TICK {tick_count}')
    if tick_count >= MAX_TICKS:
        timer.cancel()


def on_slow_add(req, res):
    log.info(f'REQ {req.a} {req.b}')
    time.sleep(3.0)
    res.sum = req.a + req.b
    log.info(f'RES {res.sum}')
    return res


if __name__ == '__main__':
    srv = node.create_service(AddTwoInts, 'slow_add', on_slow_add, callback_group=g_srv)
    timer = node.create_timer(0.1, on_tick, callback_group=g_tmr)
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, SystemExit):
        pass
    except ExternalShutdownException:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    sys.exit(0)
