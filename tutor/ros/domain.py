"""Domain ids: one for each start of a learner's process, which nothing else on this machine uses while it is held.

They lie beyond 232, where ROS's own end: no `ROS_DOMAIN_ID` that a program sets for itself leads into a check.
"""

from __future__ import annotations

import errno
import random
import socket
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tutor.errors import NoFreeDomain
from tutor.ros.discovery import DDS_PORTS, PORTS_OF_CHECKS, own_ports

IDS = tuple(id_ for id_ in range(240, 1224) if id_ % 10 in {0, 3})
"""The ids of checks. Their ports are below those that Linux gives away by itself (32768). A node that is told to use
localhost only looks for others at 64 ports from its domain's on, and Fast DDS 2.14 lets in whoever it finds there, of
whatever domain: so there are 75 ports from one id to the next, and none is among those 64 of any domain of a user."""
_UDP_TABLES = (Path("/proc/net/udp"), Path("/proc/net/udp6"))

# Each process takes them in an order of its own, and one that was just given back comes last: somebody may still have
# a packet on its way there.
_round = deque(random.SystemRandom().sample(IDS, len(IDS)))


@contextmanager
def reserve_domain() -> Iterator[int]:
    """Reserve one of `IDS` that nothing else on this machine uses, until the end of the block.

    Safe among threads, processes and users; a process that dies gives its ids back. Raises NoFreeDomain.
    """
    for _ in IDS:
        _round.rotate(-1)
        domain = _round[-1]
        # The lock is a name in the kernel alone: no file that could be left behind, and this network's, as ports are.
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as lock:
            if _binds(lock, f"\0ros-tutor-domain-{domain}") and _is_quiet(domain):
                yield domain
                return
    raise NoFreeDomain


def domains_in_use() -> frozenset[int]:
    """The ids of domains with a port that is bound on this machine."""
    first, per_domain = DDS_PORTS
    return frozenset((port - first) // per_domain for port in _all_bound_ports())


def participants_here(domain_id: int) -> int | None:
    """How many DDS participants of a domain there are on this machine, by the ports that they have bound.

    A participant is usually a process; one that this process has counts, too. None where the ports cannot be known.
    """
    layout = own_ports()
    if layout is None or not any(table.exists() for table in _UDP_TABLES):
        return None
    first, per_domain = layout
    offsets = {port - first - per_domain * domain_id for port in _all_bound_ports()}
    # The ports of participant i for discovery and for data, as RTPS numbers them.
    return sum(10 + 2 * i in offsets and 11 + 2 * i in offsets for i in range((per_domain - 10) // 2))


def _is_quiet(domain: int) -> bool:
    """Whether nothing else on this machine has bound the domain's discovery port."""
    first, per_domain = PORTS_OF_CHECKS
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as port:
        return _binds(port, ("", first + per_domain * domain))


def _binds(one: socket.socket, address: str | tuple[str, int]) -> bool:
    try:
        one.bind(address)
    except OSError as error:
        if error.errno != errno.EADDRINUSE:
            raise
        return False
    return True


def _all_bound_ports() -> Iterator[int]:
    return (port for table in _UDP_TABLES if table.exists() for port in _bound_ports(table.read_text()))


def _bound_ports(table: str) -> Iterator[int]:
    for line in table.splitlines()[1:]:
        local = line.split()[1]
        yield int(local.rpartition(":")[2], 16)
