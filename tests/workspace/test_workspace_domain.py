"""The ROS domain ID of a workspace: stable, and not shared with other workspaces."""

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

# Prints the domain ID of a workspace.
PRINT_DOMAIN = """
import sys
from pathlib import Path
from tutor.workspace import Workspace, claims, domain_of
claims.REGISTRY = Path(sys.argv[1])
print(domain_of(Workspace(Path(sys.argv[2])), {}))
"""
# Prints the domain ID of each workspace: one process for each, all of which ask when the pipe is closed.
PRINT_DOMAINS = """
import os, sys
from pathlib import Path
from tutor.ros import domain
from tutor.workspace import Workspace, claims, domain_of
claims.REGISTRY = Path(sys.argv[1])
wait, go = os.pipe()
asking = []
for root in sys.argv[2:]:
    if not (pid := os.fork()):
        os.close(go)
        os.read(wait, 1)
        os.write(1, f"{domain_of(Workspace(Path(root)), {})}\\n".encode())
        os._exit(0)
    asking.append(pid)
os.close(go)
assert not any([os.waitpid(pid, 0)[1] for pid in asking])
"""


@pytest.fixture(autouse=True)
def registry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "registry"
    monkeypatch.setattr(claims, "REGISTRY", folder)
    monkeypatch.setattr("tutor.workspace.domain._in_use", frozenset)
    return folder


def make_workspace(root: Path) -> Workspace:
    (root / ".ros-tutor").mkdir(parents=True)
    return Workspace(root)


def stored_domain(workspace: Workspace) -> int:
    return int((workspace.root / ".ros-tutor" / "domain").read_text())


def test_each_workspace_gets_its_own_stable_domain(tmp_path: Path) -> None:
    ada, bob = make_workspace(tmp_path / "ada"), make_workspace(tmp_path / "bob")
    of_ada, of_bob = domain_of(ada, {}), domain_of(bob, {})
    assert of_ada != of_bob
    assert {of_ada, of_bob} <= set(range(1, 102))  # 0 is ROS's default, which everybody else uses
    assert (stored_domain(ada), stored_domain(bob)) == (of_ada, of_bob)
    assert (domain_of(ada, {}), domain_of(bob, {})) == (of_ada, of_bob)


def test_domain_survives_the_loss_of_the_registry(tmp_path: Path, registry: Path) -> None:
    ada = make_workspace(tmp_path / "ada")
    before = domain_of(ada, {})
    for file in registry.iterdir():
        file.unlink()
    assert domain_of(ada, {}) == before
    assert claims.claimed_by(ada.root, registry) == before


def test_ros_domain_id_takes_precedence_if_valid(tmp_path: Path) -> None:
    ada = make_workspace(tmp_path / "ada")
    assert domain_of(ada, {"ROS_DOMAIN_ID": " 7 "}) == 7
    assert domain_of(ada, {"ROS_DOMAIN_ID": "0"}) == 0
    assert not (ada.root / ".ros-tutor" / "domain").exists()
    own = domain_of(ada, {"ROS_DOMAIN_ID": "seven"})
    assert (
        own == domain_of(ada, {"ROS_DOMAIN_ID": ""}) == domain_of(ada, {"ROS_DOMAIN_ID": "233"}) == stored_domain(ada)
    )


def test_domain_claimed_before_the_workspace_exists_is_kept(tmp_path: Path) -> None:
    before = domain_of(Workspace(tmp_path / "ada"), {})
    assert domain_of(make_workspace(tmp_path / "ada"), {}) == before == stored_domain(Workspace(tmp_path / "ada"))


def test_domain_is_the_same_through_a_symlink(tmp_path: Path) -> None:
    ada = make_workspace(tmp_path / "ada")
    (tmp_path / "link").symlink_to(ada.root, target_is_directory=True)
    assert domain_of(Workspace(tmp_path / "link"), {}) == domain_of(ada, {})


def test_a_copied_workspace_gets_another_domain(tmp_path: Path) -> None:
    ada = make_workspace(tmp_path / "ada")
    first = domain_of(ada, {})
    copy = make_workspace(tmp_path / "copy")
    (copy.root / ".ros-tutor" / "domain").write_text(f"{first}\n")
    assert domain_of(copy, {}) != first
    assert domain_of(ada, {}) == first
    assert stored_domain(copy) == domain_of(copy, {})


def test_an_id_written_by_the_learner_is_used(tmp_path: Path) -> None:
    ada = make_workspace(tmp_path / "ada")
    domain_of(ada, {})
    (ada.root / ".ros-tutor" / "domain").write_text("101\n")
    assert domain_of(ada, {}) == 101


@pytest.mark.parametrize("damage", [b"", b"\xff\xfe", b"forty", b"-3", b"999", "٣".encode()])
def test_a_damaged_domain_file_is_replaced(tmp_path: Path, damage: bytes) -> None:
    ada = make_workspace(tmp_path / "ada")
    before = domain_of(ada, {})
    (ada.root / ".ros-tutor" / "domain").write_bytes(damage)
    assert domain_of(ada, {}) == before == stored_domain(ada)


def test_an_id_in_use_is_avoided(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tutor.workspace.domain._in_use", lambda: frozenset(range(102)) - {33})
    assert domain_of(make_workspace(tmp_path / "ada"), {}) == 33


def test_a_running_node_marks_its_domain_as_in_use() -> None:
    from tutor.ros.domain import domains_in_use

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as node:
        for domain in range(60, 100):
            try:
                node.bind(("", 7400 + 250 * domain + 249))
                break
            except OSError:
                continue
        assert domain in domains_in_use()


def test_ids_are_shared_once_all_are_claimed(tmp_path: Path) -> None:
    got = [domain_of(make_workspace(tmp_path / str(number)), {}) for number in range(103)]
    assert len(set(got[:101])) == 101
    assert set(got[101:]) <= set(range(1, 102))


def test_claims_of_deleted_workspaces_expire(tmp_path: Path, registry: Path) -> None:
    domain_of(Workspace(tmp_path / "gone"), {})
    [claim] = [file for file in registry.iterdir() if file.name != "lock"]
    long_ago = time.time() - 2 * 86400
    os.utime(claim, (long_ago, long_ago))
    domain_of(make_workspace(tmp_path / "ada"), {})
    assert not claim.exists()


# --- concurrency ---


def ask_concurrently(registry: Path, roots: list[Path]) -> list[int]:
    """Ask for the domain ID of each root, all at the same moment and each in its own process."""
    ran = subprocess.run(
        [sys.executable, "-c", PRINT_DOMAINS, registry, *roots],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert ran.returncode == 0, ran.stderr
    domains = [int(line) for line in ran.stdout.splitlines()]
    assert len(domains) == len(roots)
    return domains


def test_concurrent_processes_and_threads_agree_on_one_workspace(tmp_path: Path, registry: Path) -> None:
    ada = make_workspace(tmp_path / "ada")
    got = ask_concurrently(registry, [ada.root] * 10)
    with ThreadPoolExecutor(20) as pool:
        got += pool.map(lambda _: domain_of(ada, {}), range(20))
    assert set(got) == {stored_domain(ada)}


def test_concurrent_threads_agree_on_a_new_workspace(tmp_path: Path) -> None:
    ada = make_workspace(tmp_path / "ada")
    with ThreadPoolExecutor(20) as pool:
        got = set(pool.map(lambda _: domain_of(ada, {}), range(20)))
    assert got == {stored_domain(ada)}


def test_concurrent_workspaces_get_distinct_ids(
    tmp_path: Path, registry: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # All prefer the same IDs.
    monkeypatch.setattr(claims, "preferred_order", lambda workspace: list(claims.USABLE_DOMAINS))
    workspaces = [make_workspace(tmp_path / str(number)) for number in range(20)]
    with ThreadPoolExecutor(20) as pool:
        got = list(pool.map(lambda workspace: domain_of(workspace, {}), workspaces))
    assert sorted(got) == list(range(1, 21))
    assert (
        len(
            {
                *got,
                *ask_concurrently(registry, [make_workspace(tmp_path / f"more-{number}").root for number in range(10)]),
            }
        )
        == 30
    )


# --- unusable registries ---


def assert_stable_domain(workspace: Workspace) -> None:
    """Assert that the workspace gets a valid domain ID and keeps it, even without a usable registry."""
    first = domain_of(workspace, {})
    assert first in claims.USABLE_DOMAINS
    assert domain_of(workspace, {}) == first == stored_domain(workspace)


def test_a_symlink_in_place_of_the_registry_is_not_followed(tmp_path: Path, registry: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir(mode=0o755)
    registry.symlink_to(elsewhere, target_is_directory=True)
    assert_stable_domain(make_workspace(tmp_path / "ada"))
    assert list(elsewhere.iterdir()) == []
    assert elsewhere.stat().st_mode & 0o7777 == 0o755


def test_a_file_in_place_of_the_registry_does_no_harm(tmp_path: Path, registry: Path) -> None:
    registry.write_text("mine\n")
    assert_stable_domain(make_workspace(tmp_path / "ada"))
    assert registry.read_text() == "mine\n"


def test_a_symlinked_lock_is_not_followed(tmp_path: Path, registry: Path) -> None:
    registry.mkdir()
    (registry / "lock").symlink_to(tmp_path / "target")
    assert_stable_domain(make_workspace(tmp_path / "ada"))
    assert not (tmp_path / "target").exists()


def test_links_pipes_and_malformed_claims_are_ignored(
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
    monkeypatch.setattr(claims, "preferred_order", lambda workspace: [5, 6])
    assert domain_of(Workspace(tmp_path / "nobody else's"), {}) == 5
    assert_stable_domain(make_workspace(tmp_path / "ada"))


@pytest.mark.skipif(os.getuid() != 0, reason="only root may become two other users")
def test_two_users_share_the_registry_but_not_their_claims(tmp_path: Path, registry: Path) -> None:
    os.chmod(tmp_path, 0o777)
    for parent in list(tmp_path.parents)[:-2]:  # below /tmp
        os.chmod(parent, 0o755)
    programs = []
    for user in (20001, 20002):
        root = make_workspace(tmp_path / str(user)).root
        for path in (root, root / ".ros-tutor"):
            os.chown(path, user, user)
        code = f"import os; os.setgid({user}); os.setuid({user}); os.umask(0o077)\n{PRINT_DOMAIN}"
        programs.append((root, code))
    domains = []
    for root, code in programs:
        code = code.replace(
            "print(domain_of", "claims.preferred_order = lambda workspace: list(claims.USABLE_DOMAINS)\nprint(domain_of"
        )
        # Import while still root: the other users may not read the source folder.
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
def test_an_unwritable_registry_of_another_user_does_no_harm(tmp_path: Path, registry: Path) -> None:
    registry.mkdir(mode=0o755)
    os.chmod(tmp_path, 0o755)
    for parent in list(tmp_path.parents)[:-2]:  # below /tmp
        os.chmod(parent, 0o755)
    root = make_workspace(tmp_path / "ada").root
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
    assert stored_domain(Workspace(root)) == int(done.stdout.split()[0])
    assert list(registry.iterdir()) == []
