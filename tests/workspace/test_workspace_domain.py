"""The ROS domain of a workspace: its own, for good, and nobody else's."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tutor.workspace import Workspace, claims, domain_of

ROOT = Path(claims.__file__).parents[2]

# Waits until all are there, and asks for the domain of its workspace.
ASK = """
import sys
from pathlib import Path
from tutor.workspace import Workspace, claims, domain_of
claims.REGISTRY = Path(sys.argv[1])
print("here", flush=True)
input()
print(domain_of(Workspace(Path(sys.argv[2])), {}))
"""


@pytest.fixture(autouse=True)
def registry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "registry"
    monkeypatch.setattr(claims, "REGISTRY", folder)
    monkeypatch.setattr("tutor.workspace.domain._in_use", frozenset)
    return folder


def made(root: Path) -> Workspace:
    (root / ".ros-tutor").mkdir(parents=True)
    return Workspace(root)


def kept(workspace: Workspace) -> int:
    return int((workspace.root / ".ros-tutor" / "domain").read_text())


def test_it_is_one_of_its_own_and_stays(tmp_path: Path) -> None:
    ada, bob = made(tmp_path / "ada"), made(tmp_path / "bob")
    of_ada, of_bob = domain_of(ada, {}), domain_of(bob, {})
    assert of_ada != of_bob
    assert {of_ada, of_bob} <= set(range(1, 102))  # 0 is where everybody else is
    assert (kept(ada), kept(bob)) == (of_ada, of_bob)
    assert (domain_of(ada, {}), domain_of(bob, {})) == (of_ada, of_bob)


def test_it_stays_when_the_machine_has_forgotten(tmp_path: Path, registry: Path) -> None:
    ada = made(tmp_path / "ada")
    before = domain_of(ada, {})
    for file in registry.iterdir():
        file.unlink()
    assert domain_of(ada, {}) == before
    assert claims.claimed_by(ada.root, registry) == before


def test_what_the_variable_says_wins(tmp_path: Path) -> None:
    ada = made(tmp_path / "ada")
    assert domain_of(ada, {"ROS_DOMAIN_ID": " 7 "}) == 7
    assert domain_of(ada, {"ROS_DOMAIN_ID": "0"}) == 0
    assert not (ada.root / ".ros-tutor" / "domain").exists()
    own = domain_of(ada, {"ROS_DOMAIN_ID": "seven"})
    assert own == domain_of(ada, {"ROS_DOMAIN_ID": ""}) == domain_of(ada, {"ROS_DOMAIN_ID": "233"}) == kept(ada)


def test_a_workspace_that_is_made_later_keeps_it(tmp_path: Path) -> None:
    before = domain_of(Workspace(tmp_path / "ada"), {})
    assert domain_of(made(tmp_path / "ada"), {}) == before == kept(Workspace(tmp_path / "ada"))


def test_it_is_the_same_by_any_path(tmp_path: Path) -> None:
    ada = made(tmp_path / "ada")
    (tmp_path / "link").symlink_to(ada.root, target_is_directory=True)
    assert domain_of(Workspace(tmp_path / "link"), {}) == domain_of(ada, {})


def test_a_copy_of_a_workspace_gets_another(tmp_path: Path) -> None:
    ada = made(tmp_path / "ada")
    first = domain_of(ada, {})
    copy = made(tmp_path / "copy")
    (copy.root / ".ros-tutor" / "domain").write_text(f"{first}\n")
    assert domain_of(copy, {}) != first
    assert domain_of(ada, {}) == first
    assert kept(copy) == domain_of(copy, {})


def test_an_id_that_the_learner_wrote_there_is_taken(tmp_path: Path) -> None:
    ada = made(tmp_path / "ada")
    domain_of(ada, {})
    (ada.root / ".ros-tutor" / "domain").write_text("101\n")
    assert domain_of(ada, {}) == 101


@pytest.mark.parametrize("damage", [b"", b"\xff\xfe", b"forty", b"-3", b"999", "٣".encode()])
def test_a_damaged_file_is_replaced(tmp_path: Path, damage: bytes) -> None:
    ada = made(tmp_path / "ada")
    before = domain_of(ada, {})
    (ada.root / ".ros-tutor" / "domain").write_bytes(damage)
    assert domain_of(ada, {}) == before == kept(ada)


def test_an_id_in_use_is_avoided(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tutor.workspace.domain._in_use", lambda: frozenset(range(102)) - {33})
    assert domain_of(made(tmp_path / "ada"), {}) == 33


def test_a_node_that_runs_is_seen() -> None:
    from tutor.ros.domain import domains_in_use

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as node:
        for domain in range(60, 100):
            try:
                node.bind(("", 7400 + 250 * domain + 249))
                break
            except OSError:
                continue
        assert domain in domains_in_use()


def test_more_workspaces_than_ids_still_get_one(tmp_path: Path) -> None:
    got = [domain_of(made(tmp_path / str(number)), {}) for number in range(103)]
    assert len(set(got[:101])) == 101
    assert set(got[101:]) <= set(range(1, 102))


def test_ids_of_workspaces_that_are_gone_come_back(tmp_path: Path, registry: Path) -> None:
    domain_of(Workspace(tmp_path / "gone"), {})
    [claim] = [file for file in registry.iterdir() if file.name != "lock"]
    long_ago = time.time() - 2 * 86400
    os.utime(claim, (long_ago, long_ago))
    domain_of(made(tmp_path / "ada"), {})
    assert not claim.exists()


# --- many at once ---


def together(registry: Path, roots: list[Path]) -> list[int]:
    """Processes that ask at the same moment, one for each root; what each was told."""
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    started = [
        subprocess.Popen([sys.executable, "-c", ASK, registry, root], env=env, stdin=-1, stdout=-1, text=True)
        for root in roots
    ]
    for process in started:
        assert process.stdout is not None
        assert process.stdout.readline() == "here\n"
    for process in started:
        assert process.stdin is not None
        process.stdin.write("\n")
        process.stdin.flush()
    return [int(process.communicate(timeout=60)[0]) for process in started]


def test_twenty_at_once_on_one_workspace_agree(tmp_path: Path, registry: Path) -> None:
    ada = made(tmp_path / "ada")
    got = together(registry, [ada.root] * 10)
    with ThreadPoolExecutor(20) as pool:
        got += pool.map(lambda _: domain_of(ada, {}), range(20))
    assert set(got) == {kept(ada)}


def test_twenty_threads_on_one_new_workspace_agree(tmp_path: Path) -> None:
    ada = made(tmp_path / "ada")
    with ThreadPoolExecutor(20) as pool:
        got = set(pool.map(lambda _: domain_of(ada, {}), range(20)))
    assert got == {kept(ada)}


def test_twenty_workspaces_at_once_get_twenty(tmp_path: Path, registry: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(claims, "preferred", lambda workspace: list(claims.USABLE))  # all of them want the first
    workspaces = [made(tmp_path / str(number)) for number in range(20)]
    with ThreadPoolExecutor(20) as pool:
        got = list(pool.map(lambda workspace: domain_of(workspace, {}), workspaces))
    assert sorted(got) == list(range(1, 21))
    assert len({*got, *together(registry, [made(tmp_path / f"more-{number}").root for number in range(10)])}) == 30


# --- a registry that cannot be used ---


def usual(workspace: Workspace) -> None:
    """Without a registry: still an id, kept in the workspace, and the same one each time."""
    first = domain_of(workspace, {})
    assert first in claims.USABLE
    assert domain_of(workspace, {}) == first == kept(workspace)


def test_a_link_in_its_place_is_not_followed(tmp_path: Path, registry: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir(mode=0o755)
    registry.symlink_to(elsewhere, target_is_directory=True)
    usual(made(tmp_path / "ada"))
    assert list(elsewhere.iterdir()) == []
    assert elsewhere.stat().st_mode & 0o7777 == 0o755


def test_a_file_in_its_place_does_no_harm(tmp_path: Path, registry: Path) -> None:
    registry.write_text("mine\n")
    usual(made(tmp_path / "ada"))
    assert registry.read_text() == "mine\n"


def test_a_lock_that_is_a_link_is_not_followed(tmp_path: Path, registry: Path) -> None:
    registry.mkdir()
    (registry / "lock").symlink_to(tmp_path / "target")
    usual(made(tmp_path / "ada"))
    assert not (tmp_path / "target").exists()


def test_a_claim_that_is_a_link_or_a_pipe_or_no_claim_is_passed_over(
    tmp_path: Path, registry: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    registry.mkdir()
    uid = os.getuid()
    (tmp_path / "target").write_text('{"domain": 5, "workspace": "/"}')
    (registry / f"{uid}-link").symlink_to(tmp_path / "target")
    os.mkfifo(registry / f"{uid}-pipe")
    (registry / f"{uid}-folder").mkdir()
    (registry / f"{uid}-other").write_text('{"domain": "5", "workspace": 7}')
    (registry / f"{uid}-large").write_text("[" * 100_000)
    (registry / f"{uid + 1}-forged").write_text('{"domain": 5, "workspace": "/"}')
    monkeypatch.setattr(claims, "preferred", lambda workspace: [5, 6])
    assert domain_of(Workspace(tmp_path / "nobody else's"), {}) == 5
    usual(made(tmp_path / "ada"))


@pytest.mark.skipif(os.getuid() != 0, reason="only root may become two other users")
def test_two_users_share_it_and_cannot_change_each_others(tmp_path: Path, registry: Path) -> None:
    os.chmod(tmp_path, 0o777)
    for parent in list(tmp_path.parents)[:-2]:  # below /tmp
        os.chmod(parent, 0o755)
    got = []
    for user in (20001, 20002):
        root = made(tmp_path / str(user)).root
        for path in (root, root / ".ros-tutor"):
            os.chown(path, user, user)
        code = f"import os; os.setgid({user}); os.setuid({user}); os.umask(0o077)\n{ASK}"
        got.append((user, root, code))
    domains = []
    for _, root, code in got:
        code = code.replace('print("here", flush=True)\ninput()\n', "")
        code = code.replace(
            "print(domain_of", "claims.preferred = lambda workspace: list(claims.USABLE)\nprint(domain_of"
        )
        # Imported as root: the other users may not look into this folder.
        code = f"import tutor.workspace, tutor.ros.domain\n{code}"
        done = subprocess.run(
            [sys.executable, "-c", code, registry, root],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        domains.append(int(done.stdout))
    assert len(set(domains)) == 2
    claimed = [file for file in registry.iterdir() if file.name != "lock"]
    assert sorted(file.stat().st_uid for file in claimed) == [20001, 20002]
    assert all(file.stat().st_mode & 0o777 == 0o644 for file in claimed)
    assert registry.stat().st_mode & 0o7777 == 0o1777


@pytest.mark.skipif(os.getuid() != 0, reason="only root may become another user")
def test_a_folder_of_somebody_elses_that_cannot_be_written_to_does_no_harm(tmp_path: Path, registry: Path) -> None:
    registry.mkdir(mode=0o755)
    os.chmod(tmp_path, 0o755)
    for parent in list(tmp_path.parents)[:-2]:  # below /tmp
        os.chmod(parent, 0o755)
    root = made(tmp_path / "ada").root
    for path in (root, root / ".ros-tutor"):
        os.chown(path, 20001, 20001)
    code = (
        "import sys, os, tutor.workspace, tutor.ros.domain; from pathlib import Path\n"
        "from tutor.workspace import Workspace, claims, domain_of\n"
        "os.setgid(20001); os.setuid(20001); claims.REGISTRY = Path(sys.argv[1])\n"
        "print(*[domain_of(Workspace(Path(sys.argv[2])), {}) for _ in range(3)])\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, registry, root],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert len(set(done.stdout.split())) == 1
    assert kept(Workspace(root)) == int(done.stdout.split()[0])
    assert list(registry.iterdir()) == []
