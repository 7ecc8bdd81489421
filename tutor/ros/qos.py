"""Converts QoS between rclpy and our model of it."""

from __future__ import annotations

from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from tutor.ros_model import QoS

_INFINITE_S = 1e9


def from_rclpy(profile: QoSProfile) -> QoS:
    """Return the policies of a profile that decide whether endpoints are compatible."""
    return QoS(
        reliability=profile.reliability.short_key,
        durability=profile.durability.short_key,
        deadline_s=_finite_s(profile.deadline),
        liveliness=profile.liveliness.short_key,
        lease_s=_finite_s(profile.liveliness_lease_duration),
    )


def to_rclpy(qos: QoS, depth: int) -> QoSProfile:
    """Return the profile of an endpoint of ours, which offers or requests only this reliability and durability."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=ReliabilityPolicy.get_from_short_key(qos.reliability),
        durability=DurabilityPolicy.get_from_short_key(qos.durability),
    )


def _finite_s(duration: Duration) -> float | None:
    """Return a duration in seconds; None if it is infinite or left at the default."""
    seconds = duration.nanoseconds * 1e-9
    return seconds if 0 < seconds < _INFINITE_S else None
