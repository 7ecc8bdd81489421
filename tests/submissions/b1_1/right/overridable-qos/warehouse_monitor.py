import rclpy
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from std_msgs.msg import Int32, String


class WarehouseMonitor(Node):
    def __init__(self):
        super().__init__("warehouse_monitor")
        self.listen(String, "map", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        self.listen(Int32, "range", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
        self.listen(String, "parcels", QoSProfile(depth=256))

    def listen(self, kind, topic, profile):
        events = SubscriptionEventCallbacks(
            incompatible_qos=lambda event: self.get_logger().error(f"{topic} offers less than we ask for")
        )
        self.create_subscription(
            kind,
            topic,
            lambda message: self.get_logger().info(f"[{topic}] {message.data}"),
            profile,
            event_callbacks=events,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )


def main():
    rclpy.init()
    try:
        rclpy.spin(WarehouseMonitor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
