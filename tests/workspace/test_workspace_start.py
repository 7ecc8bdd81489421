"""Starting an exercise: which files it creates, and which it never overwrites."""

from __future__ import annotations

import sys
import types
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tutor.content import Lesson
from tutor.errors import StorageError, WorkspaceError
from tutor.workspace import Workspace, find_workspace, start, start_in


def read_tree(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_the_first_start_creates_a_complete_ros_workspace(publisher: Lesson, workspace: Workspace) -> None:
    started = start(publisher, workspace)

    assert started.created_workspace
    assert workspace.exists
    package = workspace.root / "src" / "my_package"
    assert started.files.written == (package / "my_package" / "temperature_publisher.py",)
    assert set(read_tree(workspace.root)) == {
        ".gitignore",
        ".ros-tutor/progress.json",
        ".ros-tutor/progress.lock",
        "src/my_package/package.xml",
        "src/my_package/setup.py",
        "src/my_package/setup.cfg",
        "src/my_package/resource/my_package",
        "src/my_package/my_package/__init__.py",
        "src/my_package/my_package/minimal_publisher.py",
        "src/my_package/my_package/minimal_subscriber.py",
        "src/my_package/my_package/temperature_publisher.py",
    }
    assert (package / "launch").is_dir()
    assert workspace.progress().read().of("i1.1").started_at is not None


def test_a_launch_file_goes_where_ros2_launch_looks(launch: Lesson, workspace: Workspace) -> None:
    start(launch, workspace)
    assert (workspace.root / "src/my_package/launch/my_launch.py").read_text() == "# skeleton of my_launch.py\n"


def test_starting_again_changes_nothing(publisher: Lesson, workspace: Workspace) -> None:
    start(publisher, workspace)
    before = read_tree(workspace.root)

    again = start(publisher, workspace)

    assert not again.created_workspace
    assert again.files.written == ()
    assert [path.name for path in again.files.already_there] == ["temperature_publisher.py"]
    assert read_tree(workspace.root) == before


def test_an_existing_file_stops_the_start_before_anything_is_written(calculator: Lesson, workspace: Workspace) -> None:
    mine = workspace.path_of("calculator_server.py")
    mine.parent.mkdir(parents=True)
    mine.write_text("my work")

    with pytest.raises(WorkspaceError, match=r"calculator_server\.py already exists.*--force"):
        start(calculator, workspace)

    assert read_tree(workspace.root) == {"src/my_package/my_package/calculator_server.py": b"my work"}


def test_force_backs_up_every_version_it_replaces(publisher: Lesson, workspace: Workspace) -> None:
    start(publisher, workspace)
    file = workspace.path_of("temperature_publisher.py")
    for version in ("first", "second"):
        file.write_text(version)
        started = start(publisher, workspace, force=True)
        assert started.files.backups[0].read_text() == version

    assert file.read_text() == "# skeleton of temperature_publisher.py\n"
    assert file.with_name("temperature_publisher.py.~1~").read_text() == "first"
    assert file.with_name("temperature_publisher.py.~2~").read_text() == "second"


def test_force_leaves_the_learners_own_package_files_alone(publisher: Lesson, workspace: Workspace) -> None:
    start(publisher, workspace)
    (workspace.package / "setup.py").write_text("# mine")
    start(publisher, workspace, force=True)
    assert (workspace.package / "setup.py").read_text() == "# mine"


def test_a_dangling_symlink_is_not_written_through(publisher: Lesson, tmp_path: Path) -> None:
    folder = tmp_path / "d"
    folder.mkdir()
    (folder / "temperature_publisher.py").symlink_to(tmp_path / "elsewhere.py")
    with pytest.raises(WorkspaceError, match="already exists"):
        start_in(publisher, folder)
    assert not (tmp_path / "elsewhere.py").exists()


def test_bare_files_go_into_any_folder(calculator: Lesson, tmp_path: Path) -> None:
    start_in(calculator, tmp_path / "new" / "folder")
    assert set(read_tree(tmp_path / "new" / "folder")) == {"calculator_server.py", "calculator_client.py"}


def test_a_file_in_place_of_the_workspace_is_reported(publisher: Lesson, tmp_path: Path) -> None:
    (tmp_path / "ws").write_text("")
    with pytest.raises(WorkspaceError, match=r"/ws is a file, but a folder"):
        start(publisher, Workspace(tmp_path / "ws"))


@pytest.fixture
def locked_folder(tmp_path: Path, permissions_enforced: None) -> Iterator[Path]:
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o500)
    yield folder
    folder.chmod(0o700)


def test_an_unwritable_folder_is_a_clear_error(publisher: Lesson, locked_folder: Path) -> None:
    with pytest.raises(StorageError, match=r"cannot write to .*/locked: permission denied"):
        start(publisher, Workspace(locked_folder / "ws"))


def test_a_write_that_fails_halfway_is_rolled_back(
    calculator: Lesson, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "calculator_server.py").write_text("my work")
    real_open = Path.open

    def full_disk(self: Path, mode: str = "r", *args: Any, **kwargs: Any) -> Any:
        if self.name == "calculator_client.py" and "x" in mode:
            raise OSError(28, "No space left on device")
        return real_open(self, mode, *args, **kwargs)

    monkeypatch.setattr(Path, "open", full_disk)
    with pytest.raises(StorageError, match="No space left on device"):
        start_in(calculator, tmp_path, force=True)
    monkeypatch.undo()

    assert [path.name for path in tmp_path.glob("*.py*")] == ["calculator_server.py"]
    assert (tmp_path / "calculator_server.py").read_text() == "my work"


def test_setup_py_covers_the_exercises_that_were_started(
    publisher: Lesson, launch: Lesson, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    start(publisher, workspace)
    start(launch, workspace)
    package = workspace.package
    workspace.path_of("temperature_publisher.py").write_text("def main():\n    pass\n")
    (package / "my_package" / "helpers.py").write_text("x = 1\n")
    (package / "launch" / "__pycache__").mkdir()
    (package / "launch" / "my_launch.py.~1~").write_text("")

    described: dict[str, Any] = {}
    setuptools = types.ModuleType("setuptools")
    setuptools.setup = described.update  # type: ignore[attr-defined]
    setuptools.find_packages = lambda **_: ["my_package"]  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "setuptools", setuptools)
    monkeypatch.chdir(package)
    exec(compile((package / "setup.py").read_text(), "setup.py", "exec"), {"__name__": "__main__"})

    assert described["entry_points"]["console_scripts"] == [
        "minimal_publisher = my_package.minimal_publisher:main",
        "minimal_subscriber = my_package.minimal_subscriber:main",
        "temperature_publisher = my_package.temperature_publisher:main",
    ]
    installed = dict(described["data_files"])
    assert installed["share/my_package/launch"] == ["launch/my_launch.py"]
    for sources in installed.values():
        assert all((package / source).is_file() for source in sources)


def test_precedence_of_workspace_locations(home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert find_workspace() == home / "ros_tutor_ws"

    around = tmp_path / "around"
    (around / ".ros-tutor").mkdir(parents=True)
    (around / "src" / "deep").mkdir(parents=True)
    monkeypatch.chdir(around / "src" / "deep")
    assert find_workspace() == around

    monkeypatch.setenv("ROS_TUTOR_WORKSPACE", "~/named")
    assert find_workspace() == home / "named"

    assert find_workspace(Path("given")) == around / "src" / "deep" / "given"

    monkeypatch.setenv("ROS_TUTOR_WORKSPACE", "")
    assert find_workspace() == around


def test_a_deleted_current_folder_is_tolerated(home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    assert find_workspace() == home / "ros_tutor_ws"
