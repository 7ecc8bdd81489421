"""Generated lessons, and a workspace in an empty home directory."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tutor.content import CriterionText, Difficulty, Lesson, LessonFile
from tutor.workspace import Workspace


def make_lesson(folder: Path, lesson_id: str, names: list[str], optional: tuple[str, ...] = ()) -> Lesson:
    files = []
    for name in names:
        for kind in ("skeleton", "solution"):
            (folder / kind).mkdir(parents=True, exist_ok=True)
            (folder / kind / name).write_text(f"# {kind} of {name}\n")
        files.append(LessonFile(name, name not in optional, folder / "skeleton" / name, folder / "solution" / name))
    return Lesson(
        id=lesson_id,
        title=f"Lesson {lesson_id}",
        difficulty=Difficulty.EASY,
        unit="A unit",
        objective="Learn.",
        files=tuple(files),
        criteria=(
            CriterionText("publishes", "It publishes.", bonus=False, open=True, hint=""),
            CriterionText("shutdown", "It stops.", bonus=True, open=True, hint=""),
        ),
        hints=("Look.", "Look closer.", "Do this."),
        checklist=(),
        body="Text.\n",
        folder=folder,
    )


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    home = tmp_path / "home"
    home.mkdir()
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.delenv("ROS_TUTOR_WORKSPACE", raising=False)
    monkeypatch.chdir(home)
    return home


@pytest.fixture
def permissions_enforced(tmp_path: Path) -> None:
    """Skip the test if file permissions do not restrict this user, as for root."""
    probe = tmp_path / "probe"
    probe.touch(mode=0o000)
    if os.access(probe, os.R_OK):
        pytest.skip("file permissions do not restrict this user")


@pytest.fixture
def publisher(tmp_path: Path) -> Lesson:
    return make_lesson(tmp_path / "course" / "i1_1", "i1.1", ["temperature_publisher.py"])


@pytest.fixture
def calculator(tmp_path: Path) -> Lesson:
    names = ["calculator_server.py", "calculator_client.py"]
    return make_lesson(tmp_path / "course" / "i1_3", "i1.3", names, optional=("calculator_client.py",))


@pytest.fixture
def launch(tmp_path: Path) -> Lesson:
    return make_lesson(tmp_path / "course" / "i2_2", "i2.2", ["my_launch.py"])


@pytest.fixture
def workspace(home: Path) -> Workspace:
    return Workspace(home / "ws")
