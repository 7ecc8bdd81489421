################################################################################
#
#  Temperature manager
#
#  SPDX-License-Identifier: Apache-2.0
#
################################################################################

import random
from typing import Optional

import rclpy.node
import rclpy.publisher
import rclpy.qos
from rclpy.executors import ExternalShutdownException
from rclpy.logging import LoggingSeverity
from rclpy.qos import HistoryPolicy
from rclpy.qos import ReliabilityPolicy
from std_msgs.msg import Float64 as Float64Msg


################################################################################
# Hardware configuration
################################################################################


# Limits of the simulated sensor, in degrees Celsius
MIN_TEMPERATURE: float = 20.0
MAX_TEMPERATURE: float = 30.0


################################################################################
# ROS parameters
################################################################################


NODE_NAME = "temperature_manager"

DEFAULT_PUBLISH_PERIOD_SECS = 1.0
DEFAULT_SENSOR_NAME = "boiler"

# Publisher
PUBLISH_TEMPERATURE = "/sensor/temperature"


################################################################################
# ROS node
################################################################################


class TemperatureManagerNode(rclpy.node.Node):
    """
    A ROS node that simulates a temperature sensor.
    """

    def __init__(self) -> None:
        """
        Initialize resources.
        """
        super().__init__(NODE_NAME)

        # Keep the terminal quiet
        self.get_logger().set_level(LoggingSeverity.WARN)

        # Parameters
        self.declare_parameter("publish_period_secs", DEFAULT_PUBLISH_PERIOD_SECS)
        self.declare_parameter("sensor_name", DEFAULT_SENSOR_NAME)
        self._sensor_name: str = str(self.get_parameter("sensor_name").value)

        # Reliable QOS profile for sensor topics
        qos_profile: rclpy.qos.QoSProfile = rclpy.qos.QoSProfile(
            reliability=ReliabilityPolicy.RELIABLE,
            history=HistoryPolicy.KEEP_LAST,
            depth=10,
        )

        # Publishers
        self._temperature_pub: rclpy.publisher.Publisher = self.create_publisher(
            msg_type=Float64Msg,
            topic=PUBLISH_TEMPERATURE,
            qos_profile=qos_profile,
        )

        # Timer parameters
        self._publish_timer: Optional[rclpy.node.Timer] = None

    def initialize(self) -> bool:
        self.get_logger().debug("Starting temperature manager configuration")

        period_secs: float = float(self.get_parameter("publish_period_secs").value)
        if period_secs <= 0.0:
            self.get_logger().error("publish_period_secs must be positive")
            return False

        # Now that the manager is initialized, start the publishing timer
        self._publish_timer = self.create_timer(
            timer_period_sec=period_secs, callback=self._publish_temperature
        )

        self.get_logger().info(f"Sensor {self._sensor_name} initialized successfully")

        return True

    def _publish_temperature(self) -> None:
        msg: Float64Msg = Float64Msg()
        msg.data = random.uniform(MIN_TEMPERATURE, MAX_TEMPERATURE)
        self._temperature_pub.publish(msg)

        self.get_logger().info(f"{self._sensor_name}: {msg.data:.2f} C")


################################################################################
# Main
################################################################################


def main() -> None:
    rclpy.init()
    node = TemperatureManagerNode()
    try:
        if node.initialize():
            rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
