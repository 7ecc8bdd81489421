#!/usr/bin/env python3
"""A thread spins, and the main thread uses the blocking calls."""
import threading

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient

rclpy.init()
node = rclpy.create_node('client')
client = ActionClient(node, Fibonacci, 'countdown')
spinner = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
spinner.start()
log = node.get_logger()
if not client.wait_for_server(timeout_sec=10.0):
    raise SystemExit('no server')
event = threading.Event()
sent = client.send_goal_async(
    Fibonacci.Goal(order=4), feedback_callback=lambda msg: log.info(f'{list(msg.feedback.sequence)}'))
sent.add_done_callback(lambda _: event.set())
event.wait()
handle = sent.result()
if handle.accepted:
    result = handle.get_result().result
    log.info(f'the end: {list(result.sequence)}')
else:
    log.warn('nope')
rclpy.shutdown()
spinner.join()
