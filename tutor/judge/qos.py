"""Which publishers and subscriptions DDS matches: none where more is asked for than is offered. Pure."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, Protocol

Policy = Literal["reliability", "durability", "deadline", "liveliness", "lease"]


class Qos(Protocol):
    """The policies that decide it, by their short names. `deadline_s` and `lease_s` (seconds): None where infinite."""

    @property
    def reliability(self) -> str: ...
    @property
    def durability(self) -> str: ...
    @property
    def deadline_s(self) -> float | None: ...
    @property
    def liveliness(self) -> str: ...
    @property
    def lease_s(self) -> float | None: ...


def incompatible_policies(offered: Qos, requested: Qos) -> Iterator[Policy]:
    """The policies of which a subscription asks for more than the publisher offers."""
    if (offered.reliability, requested.reliability) == ("best_effort", "reliable"):
        yield "reliability"
    if (offered.durability, requested.durability) == ("volatile", "transient_local"):
        yield "durability"
    if _longer(offered.deadline_s, requested.deadline_s):
        yield "deadline"
    if _longer(offered.lease_s, requested.lease_s):
        yield "lease"
    if (offered.liveliness, requested.liveliness) == ("automatic", "manual_by_topic"):
        yield "liveliness"


def _longer(offered_s: float | None, requested_s: float | None) -> bool:
    return requested_s is not None and (offered_s is None or offered_s > requested_s)
