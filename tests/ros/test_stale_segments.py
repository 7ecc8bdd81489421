"""Shared memory of killed nodes is removed; what a living one uses stays, whichever user owns it."""

from __future__ import annotations

import fcntl
import os
import re
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import pytest

from tests.ros.users_domain import users_domain
from tutor.doctor.child import PROBE
from tutor.ros import stale_segments
from tutor.ros.discovery import DDS_PORTS
from tutor.ros.environment import detect, learner_env

LIMIT_S = 60.0
SHM = Path("/dev/shm")


@pytest.fixture
def env(tmp_path: Path) -> Iterator[dict[str, str]]:
    """Of nodes that talk over shared memory only."""
    with users_domain() as domain:
        environ = {**os.environ, "FASTDDS_BUILTIN_TRANSPORTS": "SHM"}
        yield learner_env(
            detect(environ), domain_id=domain, log_dir=tmp_path, package_root=None, isolated=False, environ=environ
        )


def locks_of(pid: int) -> set[Path]:
    """The lock files that a process has open: one of its segment, and one of each of its domain's ports.

    The ports from 7000 on are no domain's: a node of another test may open the same one at any moment.
    """
    links = []
    for each in Path(f"/proc/{pid}/fd").iterdir():
        with suppress(FileNotFoundError):  # it has just been closed
            links.append(os.readlink(each))
    found = [found for link in links if (found := re.fullmatch(r"/dev/shm/fastrtps_(?:port(\d+)|\w+)_[es]l", link))]
    return {Path(each[0]) for each in found if each[1] is None or int(each[1]) >= DDS_PORTS[0]}


@contextmanager
def talking(env: dict[str, str]) -> Iterator[tuple[subprocess.Popen[bytes], set[Path]]]:
    """A node that publishes, and its lock files."""
    node = subprocess.Popen([detect().python, PROBE, "talk", "/t"], env=env)
    try:
        deadline = time.monotonic() + LIMIT_S
        while len(locks := locks_of(node.pid)) < 4:  # its segment, two ports for discovery, and one for data
            assert time.monotonic() < deadline, locks
            time.sleep(0.01)
        yield node, locks
    finally:
        node.kill()
        node.wait()


def named(lock: Path) -> list[Path]:
    """All files of a segment or a port."""
    name = lock.name[:-3]
    return [lock, lock.with_name(name), *([lock.with_name(f"sem.{name}_mutex")] if "port" in name else [])]


def test_what_a_killed_node_leaves_goes_and_what_a_living_one_uses_stays(env: dict[str, str]) -> None:
    with talking(env) as (victim, dead), talking(env) as (_, living):
        victim.kill()
        victim.wait()
        stale_segments.remove(limit_s=LIMIT_S)
        assert not [path for lock in dead - living for path in named(lock) if path.exists()]
        assert not [path for lock in living for path in named(lock) if not path.exists()]
        heard = subprocess.run([detect().python, PROBE, "listen", "/t"], env=env, timeout=LIMIT_S, check=False)
        assert heard.returncode == 0


def test_nodes_find_each_other_while_it_is_being_removed(env: dict[str, str]) -> None:
    with ExitStack() as nodes:
        listening = subprocess.Popen([detect().python, PROBE, "listen", "/t"], env=env, stdout=subprocess.DEVNULL)
        talkers = [subprocess.Popen([detect().python, PROBE, "talk", "/t"], env=env) for _ in range(2)]
        for node in (listening, *talkers):
            nodes.callback(node.wait)
            nodes.callback(node.kill)
        deadline = time.monotonic() + LIMIT_S
        while listening.poll() is None and time.monotonic() < deadline:
            stale_segments.remove(limit_s=LIMIT_S)
            time.sleep(0.001)
        assert listening.returncode == 0


def made(place: Path, name: str) -> list[Path]:
    paths = [place / name, place / f"{name}_el"]
    for path in paths:
        path.touch()
    return paths


def test_only_files_that_are_fast_ddss_and_that_nobody_locks(tmp_path: Path) -> None:
    stale, locked = made(tmp_path, f"fastrtps_{'0' * 16}"), made(tmp_path, f"fastrtps_{'1' * 16}")
    others = [*made(tmp_path, "somebody"), *made(tmp_path, "fastrtps_short"), tmp_path / f"fastrtps_{'2' * 16}"]
    others[-1].touch()
    pipe, link = (tmp_path / f"fastrtps_{digit * 16}_el" for digit in "34")
    os.mkfifo(pipe)
    link.symlink_to(others[0])
    with locked[1].open() as handle:
        fcntl.flock(handle, fcntl.LOCK_SH)
        stale_segments.remove(tmp_path)
    assert {*tmp_path.iterdir()} == {*locked, *others, pipe, link}
    assert not any(path.exists() for path in stale)
    stale_segments.remove(tmp_path / "none")


def test_it_ends_in_time_and_goes_on_the_next_time(tmp_path: Path) -> None:
    for number in range(20):
        made(tmp_path, f"fastrtps_{number:016x}")
    stale_segments.remove(tmp_path, limit_s=0.0)
    assert len(list(tmp_path.iterdir())) > 0
    stale_segments.remove(tmp_path, limit_s=LIMIT_S)
    assert list(tmp_path.iterdir()) == []


def test_another_users_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    paths = made(tmp_path, f"fastrtps_{'0' * 16}")
    monkeypatch.setattr(os, "getuid", lambda: os.stat(tmp_path).st_uid + 1)
    stale_segments.remove(tmp_path)
    assert all(path.exists() for path in paths)
