"""What the command line and the app say of message types that cannot be built, and when they look again."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.interfaces.packages import write_package
from tutor.cli.interfaces import build_interfaces
from tutor.ros import workspace_interfaces
from tutor.session.interfaces import InterfaceBuilds
from tutor.workspace import Workspace

SAYS = "there is no type double in a definition; it is float64"


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "ws" / ".ros-tutor").mkdir(parents=True)
    return tmp_path / "ws"


def test_a_command_says_in_a_line_what_is_not_built(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_package(workspace, {"msg/Ding.msg": "double volume\nint3 x\n"})
    build_interfaces(Workspace(workspace))
    place = "src/bell_interfaces/msg/Ding.msg:1"
    assert capsys.readouterr().err == f"ros-tutor: bell_interfaces is not built: {place}: {SAYS} (and 1 more)\n"


def test_a_workspace_without_types_costs_nothing_and_says_nothing(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    build_interfaces(Workspace(workspace))
    assert capsys.readouterr().err == ""
    assert not workspace_interfaces.links_folder(workspace).exists()
    assert not InterfaceBuilds(workspace).have_changed()


def test_the_app_looks_again_when_a_definition_changes(workspace: Path) -> None:
    builds = InterfaceBuilds(workspace)
    folder = write_package(workspace, {"msg/Ding.msg": "double volume\n"})
    assert builds.have_changed()
    assert not builds.have_changed()
    builds.build(lambda text: None)
    assert builds.problems == (f"bell_interfaces is not built. src/bell_interfaces/msg/Ding.msg:1: {SAYS}",)
    assert builds.prefixes == ()
    (folder / "msg" / "Dong.msg").write_text("")
    assert builds.have_changed()


def test_processes_are_told_where_the_reasons_are(workspace: Path) -> None:
    write_package(workspace, {"msg/Ding.msg": "double volume\n"})
    InterfaceBuilds(workspace).build(lambda text: None)
    env: dict[str, str] = {}
    workspace_interfaces.add(env, workspace)
    (reason,) = Path(env[workspace_interfaces.REASONS]).iterdir()
    assert reason.name == "bell_interfaces.unbuilt"
    assert SAYS in reason.read_text()


def test_what_is_built_stays_in_the_environment_of_a_terminal(workspace: Path) -> None:
    entry = workspace_interfaces.cache_root() / "built" / "bell-1" / "lib"
    env = {"LD_LIBRARY_PATH": "/ours"}
    workspace_interfaces.keep(env, {"LD_LIBRARY_PATH": f"/other:{entry}"})
    assert env["LD_LIBRARY_PATH"] == f"{entry}:/ours"
