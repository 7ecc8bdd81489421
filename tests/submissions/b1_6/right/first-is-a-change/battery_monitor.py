import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class BatteryMonitor(Node):
    status = None
    outage = False

    def __init__(self):
        super().__init__("power")
        self.create_subscription(BatteryState, "/battery", self.cb, rclpy.qos.qos_profile_sensor_data)

    def cb(self, b: BatteryState):
        good = 0.0 <= b.percentage <= 1.0
        if not good and not self.outage:
            self.get_logger().error(f"charge is {b.percentage}")
        self.outage = not good
        if self.outage:
            return
        self.get_logger().debug(str(b))
        if b.power_supply_status != self.status:
            self.get_logger().info(f"{self.status} -> {b.power_supply_status}")
        self.status = b.power_supply_status
        if b.percentage < 0.2:
            self.get_logger().warning("low", throttle_duration_sec=2)
        if b.temperature > 45:
            self.get_logger().warning("hot", throttle_duration_sec=2)


def main():
    rclpy.init()
    node = BatteryMonitor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
