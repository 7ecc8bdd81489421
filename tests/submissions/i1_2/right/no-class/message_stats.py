import time
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

total = 0
first = last = None
t_first = 0.0
previous = None


def heard(msg):
    global total, first, last, t_first, previous
    total += 1
    if total == 1:
        first, t_first = msg.data, time.monotonic()
    last = msg.data
    number = int(msg.data.split(":")[1])
    if previous is not None and number not in (previous + 1, 0):
        log.warning(f"jump in the sequence, {previous} to {number}")
    previous = number
    if total % 10 == 0:
        log.info(f"[{total}] {first!r} .. {last!r} at {total / (time.monotonic() - t_first):.2f}/s")


rclpy.init()
node = rclpy.create_node("stats")
log = node.get_logger()
subscription = node.create_subscription(String, "chatter", heard, 10)
try:
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.1)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
finally:
    node.destroy_node()
    rclpy.try_shutdown()
