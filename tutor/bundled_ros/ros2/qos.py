"""The QoS options of verbs that publish or subscribe, and the profile they select."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from tutor.bundled_ros.ros2.parsing import Argument, argument

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

# As in rclpy's enums; spelled out so that help and usage errors do not need rclpy.
PROFILES = (
    "unknown",
    "default",
    "system_default",
    "sensor_data",
    "services_default",
    "parameters",
    "parameter_events",
    "action_status_default",
    "best_available",
)
_HISTORIES = ("system_default", "keep_last", "keep_all", "unknown")
_RELIABILITIES = ("system_default", "reliable", "best_effort", "unknown", "best_available")
_DURABILITIES = ("system_default", "transient_local", "volatile", "unknown", "best_available")
_LIVELINESSES = ("system_default", "automatic", "manual_by_topic", "unknown", "best_available")
_OVERRIDES = (
    "qos_depth",
    "qos_history",
    "qos_reliability",
    "qos_durability",
    "qos_liveliness",
    "qos_liveliness_lease_duration_seconds",
)


def qos_arguments(profile: str) -> tuple[Argument, ...]:
    """Return the `--qos-...` options; `profile` is the default preset."""
    return (
        argument("--qos-profile", choices=PROFILES, default=profile, help=f"the preset (default: {profile})"),
        argument("--qos-depth", metavar="N", type=int, help="the length of the queue"),
        argument("--qos-history", choices=_HISTORIES, help="what is kept in the queue"),
        argument("--qos-reliability", choices=_RELIABILITIES, help="whether lost messages are sent again"),
        argument("--qos-durability", choices=_DURABILITIES, help="whether late subscribers get old messages"),
        argument("--qos-liveliness", choices=_LIVELINESSES, help="how a publisher shows that it lives"),
        argument(
            "--qos-liveliness-lease-duration-seconds", type=float, help="within which time a publisher has to show it"
        ),
    )


def overrides_qos(arguments: argparse.Namespace) -> bool:
    """Return whether any option overrides the preset."""
    return any(getattr(arguments, name) is not None for name in _OVERRIDES)


def qos_from_arguments(arguments: argparse.Namespace) -> QoSProfile:
    """Return the preset with the options' overrides applied."""
    from rclpy import qos
    from rclpy.duration import Duration

    profile: QoSProfile = qos.QoSPresetProfiles.get_from_short_key(arguments.qos_profile)
    if arguments.qos_history:
        profile.history = qos.HistoryPolicy.get_from_short_key(arguments.qos_history)
    if arguments.qos_durability:
        profile.durability = qos.DurabilityPolicy.get_from_short_key(arguments.qos_durability)
    if arguments.qos_reliability:
        profile.reliability = qos.ReliabilityPolicy.get_from_short_key(arguments.qos_reliability)
    if arguments.qos_liveliness:
        profile.liveliness = qos.LivelinessPolicy.get_from_short_key(arguments.qos_liveliness)
    lease_s = arguments.qos_liveliness_lease_duration_seconds
    if lease_s and lease_s >= 0:
        profile.liveliness_lease_duration = Duration(seconds=lease_s)
    if arguments.qos_depth and arguments.qos_depth >= 0:
        profile.depth = arguments.qos_depth
    elif profile.durability == qos.DurabilityPolicy.TRANSIENT_LOCAL and profile.depth == 0:
        profile.depth = 1
    return profile
