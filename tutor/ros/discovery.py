"""How a check is kept to this machine, and how its participants find each other at once."""

from __future__ import annotations

import os
import secrets
import socket
import time
from collections.abc import Mapping
from functools import cache
from pathlib import Path

PROFILE = Path(__file__).resolve().with_name("isolated.xml")
PROMPT_PROFILE = PROFILE.with_name("prompt.xml")
_GROUP = f"239.{'.'.join(map(str, secrets.token_bytes(3)))}"
"""The multicast group in which the participants of our checks find each other. Each process that checks has one of its
own, so that a process that joins another check's domain meets nobody there."""
_LOOPBACK = "127.0.0.1"
PORTS_OF_CHECKS = (2000, 25)
"""As `DDS_PORTS`, for a check: what isolated.xml says."""
DDS_PORTS = (7400, 250)
"""The first UDP port of domain 0 where nothing else is set, and how many ports there are to a domain."""
_PROFILE_VARIABLES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")


def isolated_discovery() -> dict[str, str]:
    """The variables that keep discovery and data on this host, and apart from what other processes check.

    Multicast over the loopback interface finds a new participant in milliseconds. Where a machine has none,
    ROS's own LOCALHOST range (unicast to 127.0.0.1) serves: right, but up to some seconds slower.
    """
    return {
        # With LOCALHOST, the RMW layer writes over the profile's transports and group; its ports hold.
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT" if loopback_multicast_works() else "LOCALHOST",
        "ROS_TUTOR_GROUP": _GROUP,
        **dict.fromkeys(_PROFILE_VARIABLES, str(PROFILE)),
    }


def prompt_discovery() -> dict[str, str]:
    """The variables with which nodes that are not isolated discover each other faster; they change nothing else."""
    return dict.fromkeys(_PROFILE_VARIABLES, str(PROMPT_PROFILE))


def own_ports(environ: Mapping[str, str] = os.environ) -> tuple[int, int] | None:
    """As `DDS_PORTS`, for what this process joins; None where a DDS profile of the user's may say otherwise."""
    named = {environ[name] for name in _PROFILE_VARIABLES if environ.get(name)}
    if Path("DEFAULT_FASTRTPS_PROFILES.xml").exists():  # Fast DDS reads it from the current folder
        return None
    if named == {str(PROFILE)}:
        return PORTS_OF_CHECKS
    return None if named - {str(PROMPT_PROFILE)} else DDS_PORTS


def require_loopback() -> None:
    """Send a datagram to 127.0.0.1. Raises OSError where it does not arrive within a second."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own:
        own.settimeout(1.0)
        own.bind((_LOOPBACK, 0))
        own.sendto(b"hello", own.getsockname())
        own.recv(16)


@cache
def loopback_multicast_works() -> bool:
    """Whether a multicast datagram sent over the loopback interface comes back; tried once, within half a second."""
    return multicast_works(_LOOPBACK)


def multicast_works(interface: str, limit_s: float = 0.5) -> bool:
    """Whether a multicast datagram sent over the interface with this IPv4 address is received on it."""
    token = secrets.token_bytes(16)
    try:
        with (
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver,
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
        ):
            receiver.bind((_GROUP, 0))
            membership = socket.inet_aton(_GROUP) + socket.inet_aton(interface)
            receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
            sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(interface))
            sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)
            sender.sendto(token, receiver.getsockname())
            deadline = time.monotonic() + limit_s
            while (left := deadline - time.monotonic()) > 0:
                receiver.settimeout(left)
                if receiver.recv(64) == token:
                    return True
    except OSError:
        return False
    return False
