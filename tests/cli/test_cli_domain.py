"""ROS domains: everything that a learner runs is in one domain, apart from everyone else's."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tutor.content import load_course
from tutor.doctor.ros2 import own_domain
from tutor.session import Session
from tutor.tui.live.watcher import watcher_command
from tutor.workspace import RunOptions, Workspace, claims, domain_of


@pytest.fixture(autouse=True)
def registry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    monkeypatch.setattr(claims, "REGISTRY", tmp_path / "registry")


def ros2_domain(run: Run, monkeypatch: pytest.MonkeyPatch, *argv: str) -> str:
    """The domain in which `ros-tutor ros2` would run."""

    class ExecveCalled(BaseException):
        pass

    found: list[str] = []

    def execve(path: str, argv: list[str], env: dict[str, str]) -> None:
        found.append(env["ROS_DOMAIN_ID"])
        raise ExecveCalled

    monkeypatch.setattr(os, "execve", execve)
    with pytest.raises(ExecveCalled):
        run(*argv, "ros2", "launch", "x")
    return found[0]


def test_the_app_its_watcher_and_ros2_use_the_workspaces_domain(
    run: Run, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run("start", "i1.1", "--workspace", "ada")
    run("start", "i1.1", "--workspace", "bob")
    domains = []
    for name in ("ada", "bob"):
        session = Session(load_course(), Workspace(home / name))
        domain = domain_of(session.workspace)
        node = session.node_command(session.lessons[0].files[0], RunOptions())
        assert session.domain == domain
        assert node.env["ROS_DOMAIN_ID"] == str(domain)
        assert watcher_command(session.domain).env["ROS_DOMAIN_ID"] == str(domain)
        assert ros2_domain(run, monkeypatch, "--workspace", name) == str(domain)
        domains.append(domain)
    assert len({0, *domains}) == 3


def test_ros_domain_id_takes_precedence_everywhere(run: Run, home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run("start", "i1.1")
    monkeypatch.setenv("ROS_DOMAIN_ID", "77")
    session = Session(load_course(), Workspace(home / "ros_tutor_ws"))
    assert session.domain == 77
    assert session.node_command(session.lessons[0].files[0], RunOptions()).env["ROS_DOMAIN_ID"] == "77"
    assert ros2_domain(run, monkeypatch) == "77"
    assert "Your nodes run in ROS domain 77." in run("list").out


def test_a_session_that_moves_uses_the_domain_of_its_new_workspace(home: Path) -> None:
    session = Session(load_course(), Workspace(home / "ros_tutor_ws"))
    assert session.domain
    session.create_workspace(home / "elsewhere")
    assert session.domain == domain_of(Workspace(home / "elsewhere"))
    assert (home / "elsewhere" / ".ros-tutor" / "domain").read_text() == f"{session.domain}\n"


def test_list_shows_the_domain(run: Run, home: Path) -> None:
    assert "ROS domain" not in run("list").out
    run("start", "i1.1")
    assert f"Your nodes run in ROS domain {domain_of(Workspace(home / 'ros_tutor_ws'))}." in run("list").out


def test_doctor_shows_the_domain(run: Run, home: Path) -> None:
    run("start", "i1.1")
    workspace = home / "ros_tutor_ws"
    own = domain_of(Workspace(workspace))
    found = own_domain(workspace, {})
    assert found.ok
    assert f"domain {own}" in found.text
    assert f"export ROS_DOMAIN_ID={own}" in found.text
    assert "as ROS_DOMAIN_ID says" in own_domain(workspace, {"ROS_DOMAIN_ID": "4"}).text
    wrong = own_domain(workspace, {"ROS_DOMAIN_ID": "four"})
    assert wrong.ok is None
    assert "'four'" in wrong.text
    assert wrong.hint
