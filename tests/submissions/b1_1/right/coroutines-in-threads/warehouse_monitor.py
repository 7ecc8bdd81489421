import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32, String


class WarehouseMonitor(Node):
    def __init__(self):
        super().__init__("warehouse_monitor")
        group = ReentrantCallbackGroup()
        profiles = {
            "map": (String, QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)),
            "range": (Int32, QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)),
            "parcels": (String, QoSProfile(depth=300)),
        }
        for topic, (kind, profile) in profiles.items():
            callback = getattr(self, f"on_{topic}")
            self.create_subscription(kind, topic, callback, profile, callback_group=group)

    async def on_map(self, message):
        self.get_logger().info(f"The map is {message.data}.")

    async def on_range(self, message):
        self.get_logger().info(f"{message.data}")

    async def on_parcels(self, message):
        self.get_logger().info(f"{message.data} has arrived")


def main():
    rclpy.init()
    node = WarehouseMonitor()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
