import rclpy
from rclpy.executors import ExternalShutdownException
from sensor_msgs.msg import BatteryState


def make_callback(logger):
    seen = {"status": None, "outage": False}

    def callback(message):
        charge = message.percentage
        if not (charge >= 0 and charge <= 1):
            seen["outage"] or logger.error("outage")
            seen["outage"] = True
            return
        seen["outage"] = False
        logger.debug(f"{charge:.2f}")
        logger.info("hello, battery", once=True)
        if seen["status"] not in (None, message.power_supply_status):
            logger.info(f"status {message.power_supply_status}")
        seen["status"] = message.power_supply_status
        charge < 0.2 and logger.warning("low", throttle_duration_sec=2.0)
        message.temperature > 45 and logger.warning("hot", throttle_duration_sec=2.0)

    return callback


def main():
    rclpy.init()
    node = rclpy.create_node("battery_monitor")
    node.create_subscription(BatteryState, "/battery", make_callback(node.get_logger()), 10)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
