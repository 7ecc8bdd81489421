"""Quality of service (QoS): what endpoints offer or request, and when the two are incompatible."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class QoS:
    """The policies that decide whether two endpoints are compatible, with rclpy's short keys as values.

    `deadline_s` and `lease_s` (the liveliness lease duration) are None if infinite.
    """

    reliability: str = "reliable"
    durability: str = "volatile"
    deadline_s: float | None = None
    liveliness: str = "automatic"
    lease_s: float | None = None

    def __str__(self) -> str:
        words = [self.reliability.replace("_", " "), self.durability.replace("_", " ")]
        if self.deadline_s is not None:
            words.append(f"deadline {self.deadline_s:g} s")
        if self.liveliness != "automatic":
            words.append(f"liveliness {self.liveliness.replace('_', ' ')}")
        return ", ".join(words)


@dataclass(frozen=True, slots=True)
class QoSMismatch:
    """A policy for which a subscription requests more than the publisher offers, with both values in words."""

    policy: str
    offered: str
    requested: str

    def __str__(self) -> str:
        return (
            f"the publisher offers {self.policy} {self.offered}, the subscription asks for {self.requested}: "
            "they are not connected"
        )

    @property
    def hint(self) -> str:
        """How to fix it."""
        return f"let the subscription ask for {self.offered}, or the publisher offer {self.requested}"


def incompatible_policies(offered: QoS, requested: QoS) -> Iterator[QoSMismatch]:
    """Yield the policies that prevent a match; none if DDS connects the two endpoints."""
    if (offered.reliability, requested.reliability) == ("best_effort", "reliable"):
        yield QoSMismatch("reliability", offered.reliability, requested.reliability)
    if (offered.durability, requested.durability) == ("volatile", "transient_local"):
        yield QoSMismatch("durability", offered.durability, requested.durability)
    if _is_longer(offered.deadline_s, requested.deadline_s):
        yield QoSMismatch("deadline", _format_duration(offered.deadline_s), _format_duration(requested.deadline_s))
    if _is_longer(offered.lease_s, requested.lease_s):
        yield QoSMismatch(
            "liveliness lease duration", _format_duration(offered.lease_s), _format_duration(requested.lease_s)
        )
    if (offered.liveliness, requested.liveliness) == ("automatic", "manual_by_topic"):
        yield QoSMismatch("liveliness", offered.liveliness, requested.liveliness)


def echo_qos(offered: Iterable[QoS]) -> QoS:
    """Return what `ros2 topic echo` requests: reliable and transient local only if every publisher offers it."""
    offers = list(offered)
    is_transient_local = bool(offers) and all(offer.durability == "transient_local" for offer in offers)
    return QoS(
        reliability="reliable" if all(offer.reliability == "reliable" for offer in offers) else "best_effort",
        durability="transient_local" if is_transient_local else "volatile",
    )


def _is_longer(offered_s: float | None, requested_s: float | None) -> bool:
    return requested_s is not None and (offered_s is None or offered_s > requested_s)


def _format_duration(seconds: float | None) -> str:
    return "infinite" if seconds is None else f"{seconds:g} s"
