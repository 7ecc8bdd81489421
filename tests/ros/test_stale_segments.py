"""Shared memory of killed nodes is removed; that of living nodes stays, whoever owns it."""

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

from tests.ros.ordinary_domain import ordinary_domain
from tutor.doctor.child import PROBE
from tutor.ros import stale_segments
from tutor.ros.discovery import DDS_PORTS
from tutor.ros.environment import detect, learner_env

LIMIT_S = 60.0
SHM = Path("/dev/shm")


@pytest.fixture
def env(tmp_path: Path) -> Iterator[dict[str, str]]:
    """The environment of nodes that communicate over shared memory only."""
    with ordinary_domain() as domain:
        environ = {**os.environ, "FASTDDS_BUILTIN_TRANSPORTS": "SHM"}
        yield learner_env(
            detect(environ), domain_id=domain, log_dir=tmp_path, package_root=None, isolated=False, environ=environ
        )


def find_locks(pid: int) -> set[Path]:
    """Return the lock files that a process has open: one for its segment, and one for each of its domain's ports.

    Ports below a domain's, from 7000 on, are left out: a node of another test may open the same one at any moment.
    """
    links = []
    for each in Path(f"/proc/{pid}/fd").iterdir():
        with suppress(FileNotFoundError):  # it has just been closed
            links.append(os.readlink(each))
    found = [found for link in links if (found := re.fullmatch(r"/dev/shm/fastrtps_(?:port(\d+)|\w+)_[es]l", link))]
    return {Path(each[0]) for each in found if each[1] is None or int(each[1]) >= DDS_PORTS[0]}


@contextmanager
def talking(env: dict[str, str]) -> Iterator[tuple[subprocess.Popen[bytes], set[Path]]]:
    """Run a node that publishes; yield it and its lock files."""
    node = subprocess.Popen([detect().python, PROBE, "talk", "/t"], env=env)
    try:
        deadline = time.monotonic() + LIMIT_S
        while len(locks := find_locks(node.pid)) < 4:  # its segment, two ports for discovery, and one for data
            assert time.monotonic() < deadline, locks
            time.sleep(0.01)
        yield node, locks
    finally:
        node.kill()
        node.wait()


def related_files(lock: Path) -> list[Path]:
    """Return all files of a segment or a port."""
    name = lock.name[:-3]
    return [lock, lock.with_name(name), *([lock.with_name(f"sem.{name}_mutex")] if "port" in name else [])]


def test_files_of_a_killed_node_are_removed_and_those_of_a_living_one_kept(env: dict[str, str]) -> None:
    with talking(env) as (victim, dead), talking(env) as (_, living):
        victim.kill()
        victim.wait()
        stale_segments.remove(limit_s=LIMIT_S)
        assert not [path for lock in dead - living for path in related_files(lock) if path.exists()]
        assert not [path for lock in living for path in related_files(lock) if not path.exists()]
        heard = subprocess.run([detect().python, PROBE, "listen", "/t"], env=env, timeout=LIMIT_S, check=False)
        assert heard.returncode == 0


def test_nodes_discover_each_other_during_the_removal(env: dict[str, str]) -> None:
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


def create_segment(folder: Path, name: str) -> list[Path]:
    paths = [folder / name, folder / f"{name}_el"]
    for path in paths:
        path.touch()
    return paths


def test_only_unlocked_fast_dds_files_are_removed(tmp_path: Path) -> None:
    stale, locked = create_segment(tmp_path, f"fastrtps_{'0' * 16}"), create_segment(tmp_path, f"fastrtps_{'1' * 16}")
    others = [
        *create_segment(tmp_path, "somebody"),
        *create_segment(tmp_path, "fastrtps_short"),
        tmp_path / f"fastrtps_{'2' * 16}",
    ]
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


def test_the_removal_stops_at_its_limit_and_continues_the_next_time(tmp_path: Path) -> None:
    for number in range(20):
        create_segment(tmp_path, f"fastrtps_{number:016x}")
    stale_segments.remove(tmp_path, limit_s=0.0)
    assert len(list(tmp_path.iterdir())) > 0
    stale_segments.remove(tmp_path, limit_s=LIMIT_S)
    assert list(tmp_path.iterdir()) == []


def test_files_of_other_users_are_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    paths = create_segment(tmp_path, f"fastrtps_{'0' * 16}")
    monkeypatch.setattr(os, "getuid", lambda: os.stat(tmp_path).st_uid + 1)
    stale_segments.remove(tmp_path)
    assert all(path.exists() for path in paths)
