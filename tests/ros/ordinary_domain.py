"""An ordinary ROS domain, as a user has, for tests whose nodes are not isolated like those of a check."""

from __future__ import annotations

import random
import socket
from collections.abc import Iterator
from contextlib import contextmanager

from tutor.ros.domain import domains_in_use


@contextmanager
def ordinary_domain() -> Iterator[int]:
    """Reserve a domain id (1 to 100) that neither a node on this machine nor another test uses."""
    for domain in random.sample(range(1, 101), 100):
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as lock:
            try:
                lock.bind(f"\0ros-tutor-tests-{domain}")
            except OSError:
                continue
            if domain not in domains_in_use():
                yield domain
                return
    raise AssertionError("no domain is free")
