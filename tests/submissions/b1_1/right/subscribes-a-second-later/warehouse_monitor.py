import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32, String


class WarehouseMonitor(Node):
    def __init__(self):
        super().__init__("warehouse_monitor")
        self.todo = [
            (String, "map", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)),
            (String, "parcels", QoSProfile(depth=200)),
            (Int32, "range", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)),
        ]
        self.timer = self.create_timer(1.0, self.subscribe_to_the_next)

    def subscribe_to_the_next(self):
        kind, topic, qos = self.todo.pop(0)
        self.create_subscription(kind, topic, lambda m: self.get_logger().info(f"{topic} {m.data}"), qos)
        self.timer.timer_period_ns = 300_000_000
        if not self.todo:
            self.timer.cancel()


def main():
    rclpy.init()
    node = WarehouseMonitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
