"""Our temporary files lie where no other user of the machine can have prepared anything."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from tutor import private_folders

HOLD_TWO_FOLDERS = """
import sys, tempfile, time
from tutor import private_folders
tempfile.tempdir = sys.argv[1]
one, two = private_folders.create("run")[0], private_folders.create_until_exit("ros2")
(one / "x").touch()
print(one, two, sep="\\n", flush=True)
time.sleep(600)
"""


@pytest.fixture
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def test_the_base_folder_is_created_once_and_private_to_the_user(temporary: Path) -> None:
    assert private_folders.base() == private_folders.base() == temporary / f"ros-tutor-{os.getuid()}"
    assert private_folders.base().stat().st_mode & 0o777 == 0o700
    private_folders.base().chmod(0o777)
    assert private_folders.base().stat().st_mode & 0o777 == 0o700
    assert private_folders.logs({}) == private_folders.base() / "log"
    assert private_folders.logs({"ROS_LOG_DIR": "/x"}) == Path("/x")


def assert_base_is_elsewhere(temporary: Path) -> None:
    base = private_folders.base()
    assert base == private_folders.base() != temporary / f"ros-tutor-{os.getuid()}"
    assert base.stat().st_mode & 0o777 == 0o700
    with private_folders.temporary("run") as made:
        assert made.parent == base


def test_a_planted_symlink_is_not_followed(temporary: Path) -> None:
    (temporary / "theirs").mkdir()
    (temporary / f"ros-tutor-{os.getuid()}").symlink_to(temporary / "theirs")
    assert_base_is_elsewhere(temporary)
    assert not any((temporary / "theirs").iterdir())


@pytest.mark.skipif(os.getuid() != 0, reason="only root can give a folder to another user")
def test_a_folder_of_another_user_is_not_used(temporary: Path) -> None:
    theirs = temporary / f"ros-tutor-{os.getuid()}"
    theirs.mkdir()
    os.chown(theirs, 65534, 65534)
    assert_base_is_elsewhere(temporary)
    assert not any(theirs.iterdir())


def test_folders_of_killed_processes_are_removed_and_those_of_running_ones_kept(temporary: Path) -> None:
    command = [sys.executable, "-c", HOLD_TWO_FOLDERS, str(temporary)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        left = [Path(other.stdout.readline().strip()) for _ in range(2)]
        with private_folders.temporary("check") as own:
            assert all(path.is_dir() for path in (*left, own))
        assert not own.exists()
        other.send_signal(signal.SIGKILL)
    assert all(path.is_dir() for path in left)
    with private_folders.temporary("check"):
        assert not any(path.exists() for path in left)


def test_without_a_writable_folder_the_error_says_what_to_do(temporary: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def nowhere() -> str:
        raise FileNotFoundError(2, "No usable temporary directory found")

    monkeypatch.setattr(tempfile, "gettempdir", nowhere)
    with pytest.raises(OSError, match="set TMPDIR"):
        private_folders.base()
