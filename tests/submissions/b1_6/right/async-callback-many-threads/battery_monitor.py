import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import BatteryState


class BatteryMonitor(Node):
    def __init__(self):
        super().__init__("battery_monitor")
        self.status, self.outage = None, False
        self.create_subscription(BatteryState, "/battery", self.on_battery, 10)

    async def on_battery(self, battery):
        log = self.get_logger()
        if 0.0 <= battery.percentage <= 1.0:
            self.outage = False
        else:
            if not self.outage:
                log.error(f"bad charge: {battery.percentage}")
            self.outage = True
            return
        log.debug(f"{round(battery.percentage * 100)} percent")
        log.info("the battery talks", once=True)
        if battery.power_supply_status != self.status and self.status is not None:
            log.info("another status")
        self.status = battery.power_supply_status
        if battery.percentage < 0.2:
            log.warning("low", throttle_duration_sec=2.0)
        if battery.temperature > 45.0:
            log.warning("hot", throttle_duration_sec=2.0)


def main():
    rclpy.init()
    node = BatteryMonitor()
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
