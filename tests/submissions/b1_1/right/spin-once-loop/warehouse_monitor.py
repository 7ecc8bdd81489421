from functools import partial

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32, String

rclpy.init()
node = rclpy.create_node("warehouse_monitor")
log = node.get_logger()


def heard(where, message):
    log.warning(f"{where} says {message.data}") if where == "range" else log.info(f"{where} says {message.data}")


node.create_subscription(
    String, "map", partial(heard, "map"), QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
)
node.create_subscription(
    Int32, "range", partial(heard, "range"), QoSProfile(depth=3, reliability=ReliabilityPolicy.BEST_EFFORT)
)
node.create_subscription(String, "parcels", partial(heard, "parcels"), QoSProfile(depth=2000))
try:
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.5)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
finally:
    rclpy.try_shutdown()
