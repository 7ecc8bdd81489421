import logging
from typing import List, Sequence

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String

_LOGGER = logging.getLogger(__name__)

TOPIC = "chatter"
QUEUE_DEPTH = 10


def rate_to_period(rate_hz: float) -> float:
    """Seconds between two messages."""
    if rate_hz <= 0.0:
        raise ValueError(f"publish_rate must be positive, got {rate_hz}")
    return 1.0 / rate_hz


class ParameterizedPublisher(Node):
    """Publishes a prefix and a running number."""

    def __init__(self) -> None:
        super().__init__("parameterized_publisher")
        self._prefix: str = self.declare_parameter("message_prefix", "Hello").value
        self._rate_hz: float = self.declare_parameter("publish_rate", 1.0).value
        self._enabled: bool = self.declare_parameter("enabled", True).value
        self._sequence = 0

        self._publisher = self.create_publisher(String, TOPIC, QUEUE_DEPTH)
        self._publish_timer = self.create_timer(rate_to_period(self._rate_hz), self._on_timer)
        self.add_on_set_parameters_callback(self._on_set_parameters)
        self.get_logger().info(
            f"prefix={self._prefix!r} rate={self._rate_hz} Hz enabled={self._enabled}"
        )

    def _on_set_parameters(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        prefix, rate_hz, enabled = self._prefix, self._rate_hz, self._enabled
        for parameter in parameters:
            if parameter.name == "message_prefix":
                prefix = parameter.value
            elif parameter.name == "publish_rate":
                rate_hz = parameter.value
            elif parameter.name == "enabled":
                enabled = parameter.value

        try:
            period = rate_to_period(rate_hz)
        except ValueError as error:
            _LOGGER.debug("rejected", exc_info=True)
            return SetParametersResult(successful=False, reason=str(error))

        if rate_hz != self._rate_hz:
            self.destroy_timer(self._publish_timer)
            self._publish_timer = self.create_timer(period, self._on_timer)
        self._prefix, self._rate_hz, self._enabled = prefix, rate_hz, enabled
        return SetParametersResult(successful=True)

    def _on_timer(self) -> None:
        if not self._enabled:
            return
        self._publisher.publish(String(data=f"{self._prefix} {self._sequence}"))
        self._sequence += 1


def main(args: List[str] = []) -> None:
    rclpy.init(args=args)
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
