"""Domain ids: held by one, given back for certain. In a network of their own, where the machine allows to make one."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path

import pytest

from tests.ros.own_network import OWN_NETWORK, needs_own_network
from tutor.ros import domain
from tutor.ros.domain import NoFreeDomain, busy_domains, free_domains, reserve_domain
from tutor.ros.isolation import ports_of_checks

FIRST, PER_DOMAIN = ports_of_checks()

ROOT = Path(domain.__file__).parents[2]

# Takes twenty at once, waits until the others have theirs too, and gives them back.
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
assert all(1 <= i <= 100 for i in ids), ids
from tutor.ros.domain import free_domains
assert len(free_domains()) == 100, sorted(free_domains())
"""
)


def run(code: str) -> None:
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    env.pop("ROS_DOMAIN_ID", None)
    done = subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr


def can_be_locked(domain: int) -> bool:
    """Whether nobody holds this id; who else on this machine took it by chance does not hold it for long."""
    end = time.monotonic() + 30
    while time.monotonic() < end:
        with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as lock, suppress(OSError):
            lock.bind(("", 32768 + domain))
            return True
        time.sleep(0.05)
    return False


@needs_own_network
def test_four_processes_with_twenty_each_get_no_id_twice_and_give_all_back() -> None:
    run(IN_OWN_NETWORK)


@needs_own_network
def test_where_every_domain_is_in_use_the_error_says_so() -> None:
    run(
        OWN_NETWORK
        + """
import socket
from tutor.ros.domain import NoFreeDomain, reserve_domain
from tutor.ros.isolation import ports_of_checks
FIRST, PER_DOMAIN = ports_of_checks()
sockets = []
for d in range(1, 101):
    family = socket.AF_INET6 if d % 2 else socket.AF_INET
    sockets.append(socket.socket(family, socket.SOCK_DGRAM))
    sockets[-1].bind(("", FIRST + PER_DOMAIN * d + 10))
try:
    with reserve_domain():
        raise SystemExit("got one")
except NoFreeDomain as error:
    assert "free" in str(error) and error.mend
sockets[41].close()
with reserve_domain() as only:
    assert only == 42, only
    try:
        with reserve_domain():
            raise SystemExit("got the same one twice")
    except NoFreeDomain:
        pass
"""
    )


@needs_own_network
def test_where_every_lock_is_held_the_error_says_so() -> None:
    run(
        OWN_NETWORK
        + """
from contextlib import ExitStack
from tutor.ros.domain import NoFreeDomain, reserve_domain
with ExitStack() as held:
    ids = {held.enter_context(reserve_domain()) for _ in range(100)}
    assert ids == set(range(1, 101))
    try:
        held.enter_context(reserve_domain())
        raise SystemExit("got a 101st")
    except NoFreeDomain:
        pass
with reserve_domain():
    pass
"""
    )


def test_the_users_own_domain_is_left_to_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "55")
    assert 55 not in free_domains()


def test_an_id_that_was_just_given_back_is_not_used_again_at_once() -> None:
    ids = []
    for _ in range(5):
        with reserve_domain() as one:
            ids.append(one)
    assert len(set(ids)) == 5


def test_a_domain_with_something_on_it_counts_as_busy() -> None:
    with reserve_domain() as one:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", FIRST + PER_DOMAIN * one + PER_DOMAIN - 1))
            assert one in busy_domains()
        assert one not in busy_domains()
        assert one not in free_domains()


@pytest.mark.parametrize(
    "raised", [OSError("the learner's own"), NoFreeDomain(), RuntimeError("x"), KeyboardInterrupt()]
)
def test_whatever_the_block_raises_comes_out_as_it_is_and_the_id_is_given_back(raised: BaseException) -> None:
    with pytest.raises(type(raised)) as caught, reserve_domain() as one:
        raise raised
    assert caught.value is raised
    assert can_be_locked(one)


def test_threads_get_an_id_each() -> None:
    got: list[int] = []
    all_hold = threading.Barrier(8)

    def take() -> None:
        with reserve_domain() as one:
            got.append(one)
            all_hold.wait(timeout=20)

    threads = [threading.Thread(target=take) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(got)) == len(got) == 8


def test_ids_of_workspaces_are_the_last_to_be_taken() -> None:
    with reserve_domain(range(0, 101, 2)) as first, reserve_domain(range(1, 100, 2)) as second:
        assert (first % 2, second % 2) == (1, 0)
    with reserve_domain(range(102)) as any_of_them:
        assert 1 <= any_of_them <= 100
