"""Domain ids are reserved exclusively and always released. Runs in a network namespace where the machine allows it."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from contextlib import ExitStack
from itertools import pairwise
from pathlib import Path

import pytest

from tests.ros.own_network import OWN_NETWORK, needs_own_network
from tutor.errors import NoFreeDomain
from tutor.ros import domain
from tutor.ros.discovery import CHECK_PORTS, DDS_PORTS
from tutor.ros.domain import IDS, reserve_domain

FIRST, PER_DOMAIN = CHECK_PORTS

ROOT = Path(domain.__file__).parents[2]

# Reserves twenty ids, waits until the other processes have theirs too, and releases them.
TAKE_20 = """
from contextlib import ExitStack
from tutor.ros.domain import reserve_domain
with ExitStack() as held:
    print(*[held.enter_context(reserve_domain()) for _ in range(20)], flush=True)
    input()
"""
IN_OWN_NETWORK = (
    OWN_NETWORK
    + f"""
import subprocess, sys
taker = {TAKE_20!r}
takers = [subprocess.Popen([sys.executable, "-c", taker], stdin=-1, stdout=-1, text=True) for _ in range(4)]
lines = [taker.stdout.readline() for taker in takers]
for taker in takers:
    taker.communicate("\\n")
ids = [int(word) for line in lines for word in line.split()]
assert len(ids) == len(set(ids)) == 80, ids
from contextlib import ExitStack
from tutor.ros.domain import IDS, reserve_domain
assert set(ids) < set(IDS)
with ExitStack() as held:
    assert {{held.enter_context(reserve_domain()) for _ in IDS}} == set(IDS)
"""
)


def run(code: str) -> None:
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr


def can_be_reserved(wanted: int) -> bool:
    """Return whether this id can be reserved. Retries, since another process may hold it for a moment."""
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline:
        with ExitStack() as held:
            for _ in range(len(IDS) // 2):
                if held.enter_context(reserve_domain()) == wanted:
                    return True
        time.sleep(0.05)
    return False


LOCALHOST_PORTS = range(10, 10 + 2 * 32)
"""Offsets, from a domain's first port, of the ports that a localhost-only node probes for peers."""


def test_no_standard_domain_id_uses_the_ports_of_a_check() -> None:
    assert FIRST + PER_DOMAIN * 232 + LOCALHOST_PORTS[-1] < FIRST + PER_DOMAIN * IDS[0]
    assert FIRST + PER_DOMAIN * IDS[-1] + LOCALHOST_PORTS[-1] < 32768


def test_no_check_probes_the_ports_of_another() -> None:
    assert min(b - a for a, b in pairwise(IDS)) * PER_DOMAIN > LOCALHOST_PORTS[-1]


def test_no_users_node_probes_the_ports_of_a_check() -> None:
    probed = (0, 1, *LOCALHOST_PORTS)
    user_ports = {DDS_PORTS[0] + DDS_PORTS[1] * id_ + port for id_ in range(233) for port in probed}
    assert user_ports.isdisjoint(FIRST + PER_DOMAIN * id_ + port for id_ in IDS for port in probed)


@needs_own_network
def test_four_processes_with_twenty_ids_each_get_distinct_ids_and_release_them() -> None:
    run(IN_OWN_NETWORK)


@needs_own_network
def test_domains_with_a_taken_port_are_skipped_and_without_a_free_one_there_is_an_error() -> None:
    run(
        OWN_NETWORK
        + """
import socket
from contextlib import ExitStack
from tutor.ros.domain import IDS, reserve_domain
from tutor.errors import NoFreeDomain
from tutor.ros.discovery import CHECK_PORTS
FIRST, PER_DOMAIN = CHECK_PORTS
port = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
port.bind(("", FIRST + PER_DOMAIN * IDS[41]))
with ExitStack() as held:
    assert {held.enter_context(reserve_domain()) for _ in range(len(IDS) - 1)} == {*IDS} - {IDS[41]}
    try:
        held.enter_context(reserve_domain())
        raise SystemExit("got one too many")
    except NoFreeDomain as error:
        assert "free" in str(error) and error.hint
    port.close()
    assert held.enter_context(reserve_domain()) == IDS[41]
with reserve_domain():
    pass
"""
    )


def test_a_released_id_is_not_reused_at_once() -> None:
    ids = []
    for _ in range(5):
        with reserve_domain() as one:
            ids.append(one)
    assert len(set(ids)) == 5


@pytest.mark.parametrize(
    "raised", [OSError("the learner's own"), NoFreeDomain(), RuntimeError("x"), KeyboardInterrupt()]
)
def test_exceptions_in_the_block_propagate_and_the_id_is_released(raised: BaseException) -> None:
    with pytest.raises(type(raised)) as caught, reserve_domain() as one:
        raise raised
    assert caught.value is raised
    assert can_be_reserved(one)


def test_each_thread_gets_its_own_id() -> None:
    ids: list[int] = []
    all_hold = threading.Barrier(8)

    def take() -> None:
        with reserve_domain() as one:
            ids.append(one)
            all_hold.wait(timeout=20)

    threads = [threading.Thread(target=take) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(ids)) == len(ids) == 8
