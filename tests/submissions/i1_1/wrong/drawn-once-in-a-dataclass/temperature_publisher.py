"""ROS 2 node that exposes simulated temperature readings."""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from typing import Optional, Protocol

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64

__all__ = ["TemperaturePublisher", "main"]


class SensorReadError(RuntimeError):
    """Raised when the sensor fails to provide a measurement."""


@dataclass(frozen=True)
class ThermalSample:
    """One measurement."""

    temperature_celsius: float = random.uniform(20.0, 30.0)
    sequence: int = 0
    source: str = "simulated"

    @property
    def fahrenheit(self) -> float:
        return self.temperature_celsius * 9.0 / 5.0 + 32.0


class SensorBackend(Protocol):
    """Protocol implemented by concrete temperature backends."""

    def sample(self, sequence: int) -> ThermalSample:
        """Return the next thermal reading."""


@dataclass
class SimulatedBackend:
    """Used when hardware is absent."""

    history: list[ThermalSample] = field(default_factory=list)

    def sample(self, sequence: int) -> ThermalSample:
        reading = ThermalSample(sequence=sequence)
        self.history = self.history[-99:] + [reading]
        return reading


class TemperaturePublisher(Node):
    """Publishes thermal readings to a well-known topic."""

    def __init__(self) -> None:
        super().__init__("temperature_publisher")

        self.declare_parameter("sensor_name", "hypothalamus")
        self.declare_parameter("poll_interval", 1.0)
        self.declare_parameter("temperature_topic", "/sensor/temperature")

        self._sequence = 0
        self._sensor_name = str(self.get_parameter("sensor_name").value)
        self._backend: SensorBackend = SimulatedBackend()
        self._temperature_pub = self.create_publisher(
            Float64, str(self.get_parameter("temperature_topic").value), 10
        )

        poll_interval = float(self.get_parameter("poll_interval").value)
        self._poll_timer = self.create_timer(poll_interval, self._poll_once)
        self.get_logger().info(
            f"{self._sensor_name} ready: backend={type(self._backend).__name__} poll_interval={poll_interval:.2f}s"
        )

    def _poll_once(self) -> None:
        try:
            sample = self._backend.sample(self._sequence)
        except SensorReadError as exc:
            self.get_logger().warning(f"{self._sensor_name}: {exc}", throttle_duration_sec=30.0)
            return
        self._sequence += 1
        self._publish_sample(sample)

    def _publish_sample(self, sample: ThermalSample) -> None:
        self._temperature_pub.publish(Float64(data=float(sample.temperature_celsius)))
        self.get_logger().info(
            f"{self._sensor_name} [{sample.source} {sample.sequence}] "
            f"{sample.temperature_celsius:.2f} C / {sample.fahrenheit:.2f} F"
        )


def main(args: Optional[list[str]] = None) -> None:
    rclpy.init(args=args)
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    finally:
        node.destroy_node()
        if rclpy.ok():
            rclpy.shutdown()


if __name__ == "__main__":
    main()
