"""Domain ids: one for each scenario, used by nothing else on this machine for as long as it is held."""

from __future__ import annotations

import importlib
import os
import random
import socket
from collections.abc import Collection, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

from tutor.ros.isolation import DDS_PORTS, ports_of_checks, ports_of_this_process

FIRST, LAST = 1, 100
_UDP_TABLES = (Path("/proc/net/udp"), Path("/proc/net/udp6"))

# Every process starts somewhere else and goes round from there, so that a domain that was just given back (whose last
# packets may still be on their way) is the last to be used again. Threads that race here only start at the same place.
_last_used = random.SystemRandom().randrange(FIRST, LAST + 1)


class NoFreeDomain(Exception):
    """Every domain id is taken. `mend` says what to do."""

    mend = (
        "Close other programs that use ROS on this machine (ps -ef shows them), such as checks or nodes left running, "
        "and try again."
    )

    def __init__(self) -> None:
        super().__init__(f"No ROS domain id from {FIRST} to {LAST} is free on this machine.")


@contextmanager
def reserve_domain(others: Collection[int] = ()) -> Iterator[int]:
    """Hold a domain id (1 to 100) that nothing else on this machine uses; it is given back at the end of the block.

    `others` are ids to be left to somebody else, as long as another is free. Safe among threads and processes, and
    among other programs that use ROS's domain_coordinator; a process that dies gives its ids back. Raises NoFreeDomain.
    """
    global _last_used
    claim = _claim(others)
    try:
        domain = claim.__enter__()
    except RuntimeError:  # the coordinator tried as often as it does
        raise NoFreeDomain from None
    _last_used = domain
    # What the block raises is kept from the coordinator: it would take an OSError for a port that is in use, and go on.
    try:
        yield domain
    finally:
        claim.__exit__(None, None, None)


def busy_domains() -> frozenset[int]:
    """The domain ids of which something on this machine has bound a UDP port that a check would use."""
    return frozenset(domain for domain in _with_ports(*ports_of_checks()) if 0 <= domain <= LAST)


def domains_in_use() -> frozenset[int]:
    """The domain ids that something on this machine holds, or of which it has a port that a ROS node would use."""
    return _with_ports(*DDS_PORTS) | _reserved()


def participants_here(domain_id: int) -> int | None:
    """How many DDS participants of a domain there are on this machine, by the ports that they have bound.

    A participant is a process, mostly; one that this process has counts, too. None where the ports cannot be known.
    """
    layout = ports_of_this_process()
    if layout is None or not any(table.exists() for table in _UDP_TABLES):
        return None
    first, per_domain = layout
    offsets = {port - first - per_domain * domain_id for port in _all_bound_ports()}
    # The ports of participant i for discovery and for data, as RTPS numbers them.
    return sum(10 + 2 * i in offsets and 11 + 2 * i in offsets for i in range((per_domain - 10) // 2))


def free_domains() -> frozenset[int]:
    """The domain ids that could be reserved right now."""
    return frozenset(range(FIRST, LAST + 1)) - busy_domains() - _users_domain() - _reserved()


def _reserved() -> frozenset[int]:
    return frozenset(domain for domain in range(FIRST, LAST + 1) if not _lock_is_free(domain))


def _lock_is_free(domain: int) -> bool:
    coordinator: Any = importlib.import_module("domain_coordinator.impl")
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as lock:
        try:
            lock.bind(("", coordinator.PORT_BASE + domain))
        except OSError:
            return False
    return True


def _claim(others: Collection[int]) -> AbstractContextManager[int]:
    # Late, as all of ROS is; the sourced ROS's own, where there is one. It is plain Python, and brings no rclpy.
    coordinator: Any = importlib.import_module("domain_coordinator")
    avoided = busy_domains() | _users_domain()
    left = [domain for domain in _next_round() if domain not in avoided]
    last = {*others, *_with_ports(*DDS_PORTS)}  # an ordinary node meets whoever has the ports that it would have
    candidates = iter(sorted(left, key=lambda domain: domain in last))

    def select() -> int:
        domain = next((domain for domain in candidates if domain not in busy_domains()), None)
        if domain is None:
            raise NoFreeDomain
        return domain

    claim: AbstractContextManager[int] = coordinator.domain_id(select)
    return claim


def _next_round() -> list[int]:
    count = LAST - FIRST + 1
    return [FIRST + (_last_used - FIRST + 1 + step) % count for step in range(count)]


def _users_domain() -> frozenset[int]:
    given = os.environ.get("ROS_DOMAIN_ID", "")
    return frozenset({int(given)}) if given.isdecimal() else frozenset()


def _with_ports(first: int, per_domain: int) -> frozenset[int]:
    return frozenset((port - first) // per_domain for port in _all_bound_ports())


def _all_bound_ports() -> Iterator[int]:
    return (port for table in _UDP_TABLES if table.exists() for port in _bound_ports(table.read_text()))


def _bound_ports(table: str) -> Iterator[int]:
    for line in table.splitlines()[1:]:
        local = line.split()[1]
        yield int(local.rpartition(":")[2], 16)
