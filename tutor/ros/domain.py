"""Reserves a domain id for each run of a learner's process, exclusive on this machine while it is held.

The ids lie beyond 232, the last one that ROS allows, so that no `ROS_DOMAIN_ID` set by a program leads into a check.
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
from tutor.ros.discovery import CHECK_PORTS, DDS_PORTS, own_ports

IDS = tuple(id_ for id_ in range(240, 1224) if id_ % 10 in {0, 3})
"""Domain ids of checks. Their ports are below Linux's ephemeral range (which starts at 32768).

A localhost-only node probes 64 ports upwards from its own domain's, and Fast DDS 2.14 accepts any participant it finds
there, whatever its domain. So consecutive ids are at least 75 ports apart, and no port of theirs is probed from any
domain that a user can have.
"""
_UDP_TABLES = (Path("/proc/net/udp"), Path("/proc/net/udp6"))

# Each process goes through the ids in its own random order. One that was just released comes last, since packets to it
# may still be in flight.
_queue = deque(random.SystemRandom().sample(IDS, len(IDS)))


@contextmanager
def reserve_domain() -> Iterator[int]:
    """Reserve one of `IDS` that nothing else on this machine uses, until the end of the `with` block.

    Safe across threads, processes and users; a process that dies releases its ids. Raises NoFreeDomain.
    """
    for _ in IDS:
        _queue.rotate(-1)
        domain = _queue[-1]
        # The lock is an abstract socket: it leaves no file behind, and belongs to the network namespace, as ports do.
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as lock:
            if _try_bind(lock, f"\0ros-tutor-domain-{domain}") and _is_quiet(domain):
                yield domain
                return
    raise NoFreeDomain


def domains_in_use() -> frozenset[int]:
    """Return the ids of domains with a bound port on this machine."""
    first, per_domain = DDS_PORTS
    return frozenset((port - first) // per_domain for port in _all_bound_ports())


def participants_here(domain_id: int) -> int | None:
    """Count the DDS participants of a domain on this machine by the ports that they have bound.

    A participant is usually a process; our own ones count too. None if the ports cannot be known.
    """
    layout = own_ports()
    if layout is None or not any(table.exists() for table in _UDP_TABLES):
        return None
    first, per_domain = layout
    offsets = {port - first - per_domain * domain_id for port in _all_bound_ports()}
    # RTPS: participant i has unicast port 10 + 2i for discovery and 11 + 2i for data.
    return sum(10 + 2 * i in offsets and 11 + 2 * i in offsets for i in range((per_domain - 10) // 2))


def _is_quiet(domain: int) -> bool:
    """Return whether nothing on this machine has bound the domain's discovery port."""
    first, per_domain = CHECK_PORTS
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as port:
        return _try_bind(port, ("", first + per_domain * domain))


def _try_bind(sock: socket.socket, address: str | tuple[str, int]) -> bool:
    try:
        sock.bind(address)
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
