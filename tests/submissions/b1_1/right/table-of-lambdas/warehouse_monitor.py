import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy
from std_msgs.msg import Int32, String


def qos(depth, reliable=True, latched=False):
    return QoSProfile(
        history=QoSHistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=QoSReliabilityPolicy.RELIABLE if reliable else QoSReliabilityPolicy.BEST_EFFORT,
        durability=QoSDurabilityPolicy.TRANSIENT_LOCAL if latched else QoSDurabilityPolicy.VOLATILE,
    )


TABLE = [
    (String, "map", qos(1, latched=True)),
    (Int32, "range", qos(1, reliable=False)),
    (String, "parcels", qos(500)),
]


def main():
    rclpy.init()
    node = rclpy.create_node("warehouse_monitor")
    for kind, topic, profile in TABLE:
        node.create_subscription(
            kind, topic, lambda message, topic=topic: node.get_logger().info(f"{topic} -> {message.data}"), profile
        )
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        rclpy.try_shutdown()


main()
