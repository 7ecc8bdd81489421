"""Why a machine cannot isolate submissions, told from /proc/sys and from what bubblewrap says."""

from __future__ import annotations

from pathlib import Path

import pytest

from tutor.errors import EngineError
from tutor.process.isolation_support import BWRAP, NamespaceSupport, why_not

NO_LOOPBACK = "bwrap: loopback: Failed RTM_NEWADDR: Operation not permitted"
NO_UID_MAP = "bwrap: setting up uid map: Permission denied"
NO_NAMESPACE = (
    "bwrap: No permissions to create new namespace, likely because the kernel does not allow non-privileged user "
    "namespaces. On e.g. debian this can be enabled with 'sysctl kernel.unprivileged_userns_clone=1'."
)
NO_PROC = "bwrap: Can't mount proc on /newroot/proc: Operation not permitted"
EXHAUSTED = "bwrap: Creating new namespace failed: nesting depth or /proc/sys/user/max_*_namespaces exceeded (ENOSPC)"
NO_FOLDER = "bwrap: Can't find source path /usr: No such file or directory"
UBUNTU = NamespaceSupport(apparmor=True)


def words(problem: EngineError) -> str:
    return f"{problem}. {problem.hint}"


def test_without_bubblewrap_it_says_how_to_install_it() -> None:
    assert "bubblewrap, which is not installed. install it: sudo apt install bubblewrap" in words(
        why_not("", NamespaceSupport(), None)
    )


@pytest.mark.parametrize("said", [NO_LOOPBACK, NO_UID_MAP, NO_NAMESPACE])
def test_on_ubuntu_it_is_apparmor_and_the_fix_is_for_bubblewrap_alone(said: str) -> None:
    problem = why_not(said, UBUNTU, BWRAP)
    assert "AppArmor forbids" in str(problem)
    assert "sudo apt install apparmor-profiles" in problem.hint
    assert "extra-profiles/bwrap-userns-restrict /etc/apparmor.d/" in problem.hint
    assert "sudo apparmor_parser -r /etc/apparmor.d/bwrap-userns-restrict" in problem.hint
    assert "sysctl" not in problem.hint, "a switch for the whole machine"


def test_a_profile_that_is_there_is_only_to_be_loaded() -> None:
    problem = why_not(NO_UID_MAP, NamespaceSupport(apparmor=True, profile=True), BWRAP)
    assert problem.hint.startswith("load its profile: sudo apparmor_parser -r")


def test_the_profile_is_for_the_distributions_bubblewrap() -> None:
    problem = why_not(NO_UID_MAP, UBUNTU, "/home/ada/.local/bin/bwrap")
    assert "/home/ada/.local/bin/bwrap" in problem.hint
    assert "/usr/bin/bwrap" in problem.hint


@pytest.mark.parametrize("said", [NO_NAMESPACE, NO_PROC, "Operation not permitted"])
@pytest.mark.parametrize("root", [False, True])
def test_in_a_container_no_sysctl_or_profile_is_proposed(said: str, root: bool) -> None:
    problem = why_not(said, NamespaceSupport(root=root, apparmor=True, container=True), BWRAP)
    assert "this container" in str(problem)
    assert said in str(problem)
    assert "sudo" not in problem.hint
    assert "one for each submission" in problem.hint


def test_disabled_user_namespaces_name_the_setting() -> None:
    assert "user.max_user_namespaces is 0" in str(why_not(EXHAUSTED, NamespaceSupport(user_namespaces=0), BWRAP))
    assert "user.max_user_namespaces is 0" in str(
        why_not(EXHAUSTED, NamespaceSupport(user_namespaces=0, root=True), BWRAP)
    )
    assert "kernel.unprivileged_userns_clone is 0" in str(why_not(NO_NAMESPACE, NamespaceSupport(for_all=False), BWRAP))


@pytest.mark.parametrize(
    ("said", "machine"),
    [
        (NO_FOLDER, UBUNTU),  # AppArmor has nothing to do with it
        (NO_FOLDER, NamespaceSupport(container=True)),
        (NO_NAMESPACE, NamespaceSupport()),
        (NO_NAMESPACE, NamespaceSupport(root=True, apparmor=True, for_all=False)),  # neither is for root
        ("exit code 1", NamespaceSupport()),
    ],
)
def test_otherwise_what_bubblewrap_said_is_passed_on(said: str, machine: NamespaceSupport) -> None:
    problem = why_not(said, machine, BWRAP)
    assert str(problem) == f"bubblewrap cannot isolate anything here ({said})"
    assert problem.hint


def make(top: Path, **files: str) -> Path:
    for name, text in files.items():
        path = top / name.replace("__", "/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return top


def test_a_machine_without_such_settings_restricts_nothing(tmp_path: Path) -> None:
    assert NamespaceSupport.read(tmp_path) == NamespaceSupport(root=NamespaceSupport.read().root)


def test_settings_are_read(tmp_path: Path) -> None:
    kernel = tmp_path / "proc" / "sys" / "kernel"
    make(
        tmp_path,
        proc__sys__kernel__apparmor_restrict_unprivileged_userns="1\n",
        proc__sys__kernel__unprivileged_userns_clone="0\n",
        proc__sys__user__max_user_namespaces="0\n",
    )
    make(tmp_path / "run", **{".containerenv": ""})
    make(tmp_path / "etc" / "apparmor.d", **{"bwrap-userns-restrict": ""})
    found = NamespaceSupport.read(tmp_path)
    assert (found.apparmor, found.for_all, found.user_namespaces) == (True, False, 0)
    assert (found.container, found.profile) == (True, True)
    (kernel / "apparmor_restrict_unprivileged_userns").write_text("0\n")
    assert not NamespaceSupport.read(tmp_path).apparmor


def test_this_machine_can_be_read() -> None:
    assert NamespaceSupport.read().user_namespaces >= 0
