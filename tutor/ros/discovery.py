"""DDS discovery settings that keep a check on this machine and let its participants find each other at once."""

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
"""The multicast group for discovery in our checks. Each checking process picks its own at random, so that a program
that joins another check's domain finds nobody there."""
_LOOPBACK = "127.0.0.1"
CHECK_PORTS = (2000, 25)
"""Like `DDS_PORTS`, but for checks, as set in isolated.xml."""
DDS_PORTS = (7400, 250)
"""The default port layout of RTPS: the first UDP port of domain 0, and the number of ports per domain."""
_PROFILE_VARIABLES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")


def isolated_discovery() -> dict[str, str]:
    """Return environment variables that keep discovery and data on this host, separate from other processes' checks.

    Multicast over the loopback interface finds a new participant within milliseconds. On a machine without it, we use
    ROS's LOCALHOST range (unicast to 127.0.0.1), which is just as correct but up to a few seconds slower.
    """
    return {
        # With LOCALHOST, the RMW layer overrides the profile's transports and group, but not its ports.
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT" if loopback_multicast_works() else "LOCALHOST",
        "ROS_TUTOR_GROUP": _GROUP,
        **dict.fromkeys(_PROFILE_VARIABLES, str(PROFILE)),
    }


def prompt_discovery() -> dict[str, str]:
    """Return environment variables that only speed up discovery, for nodes that are not isolated."""
    return dict.fromkeys(_PROFILE_VARIABLES, str(PROMPT_PROFILE))


def own_ports(environ: Mapping[str, str] = os.environ) -> tuple[int, int] | None:
    """Return the port layout (as `DDS_PORTS`) of this process; None if a DDS profile of the user's may change it."""
    profiles = {environ[name] for name in _PROFILE_VARIABLES if environ.get(name)}
    if Path("DEFAULT_FASTRTPS_PROFILES.xml").exists():  # Fast DDS reads it from the current folder
        return None
    if profiles == {str(PROFILE)}:
        return CHECK_PORTS
    return None if profiles - {str(PROMPT_PROFILE)} else DDS_PORTS


def require_loopback() -> None:
    """Send a datagram to 127.0.0.1. Raises OSError if it does not arrive within a second."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        sock.settimeout(1.0)
        sock.bind((_LOOPBACK, 0))
        sock.sendto(b"hello", sock.getsockname())
        sock.recv(16)


@cache
def loopback_multicast_works() -> bool:
    """Return whether multicast over the loopback interface works. Tried once per process, for up to half a second."""
    return multicast_works(_LOOPBACK)


def multicast_works(interface: str, limit_s: float = 0.5) -> bool:
    """Return whether a multicast datagram sent over the interface with this IPv4 address arrives on it."""
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
