"""Which files are checked, and the errors for missing ones."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from tutor.content import Lesson
from tutor.errors import SubmissionError
from tutor.workspace import Workspace, find_submission, is_own, is_started, start


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    folder = tmp_path / "answer"
    folder.mkdir()
    return folder


def test_files_in_a_folder_are_found_by_the_exercises_names(calculator: Lesson, folder: Path) -> None:
    for name in ("calculator_server.py", "calculator_client.py", "helpers.py"):
        (folder / name).touch()
    submission = find_submission(calculator, folder, None)
    assert submission.exercise == "i1.3"
    assert submission.files == {name: folder / name for name in ("calculator_server.py", "calculator_client.py")}


def test_an_optional_file_may_be_missing(calculator: Lesson, folder: Path) -> None:
    (folder / "calculator_server.py").touch()
    assert set(find_submission(calculator, folder, None).files) == {"calculator_server.py"}


def test_a_single_file_of_any_name_stands_for_the_first(publisher: Lesson, folder: Path) -> None:
    (folder / "try2.py").touch()
    assert find_submission(publisher, folder / "try2.py", None).files == {
        "temperature_publisher.py": folder / "try2.py"
    }


def test_a_single_file_brings_the_exercises_other_files_beside_it(calculator: Lesson, folder: Path) -> None:
    for name in ("calculator_server.py", "calculator_client.py"):
        (folder / name).touch()
    submission = find_submission(calculator, folder / "calculator_client.py", None)
    assert submission.files == {name: folder / name for name in ("calculator_server.py", "calculator_client.py")}


def test_a_relative_path_is_made_absolute(publisher: Lesson, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "temperature_publisher.py").touch()
    monkeypatch.chdir(folder)
    for path in (Path("."), Path("temperature_publisher.py")):
        assert find_submission(publisher, path, None).files == {
            "temperature_publisher.py": folder / "temperature_publisher.py"
        }


def test_the_workspace_may_be_given_as_a_path(publisher: Lesson, workspace: Workspace) -> None:
    start(publisher, workspace)
    expected = find_submission(publisher, None, workspace)
    assert expected.files == {"temperature_publisher.py": workspace.path_of("temperature_publisher.py")}
    assert find_submission(publisher, workspace.root, None) == expected
    assert is_own(expected, workspace)
    assert is_own(find_submission(publisher, workspace.path_of("temperature_publisher.py"), None), workspace)


def test_a_file_elsewhere_is_not_the_workspaces_own(publisher: Lesson, workspace: Workspace, folder: Path) -> None:
    start(publisher, workspace)
    (folder / "temperature_publisher.py").touch()
    assert not is_own(find_submission(publisher, folder, workspace), workspace)


@pytest.mark.parametrize(
    ("present", "message"),
    [
        ([], r"i1\.1 needs temperature_publisher\.py, but the folder .*/answer is empty$"),
        (["temperature_pub.py"], r"not in .*/answer \(found temperature_pub\.py there: .*rename it"),
        (["Temperature_Publisher.py"], r"found Temperature_Publisher\.py there"),
        (["notes.txt"], r"i1\.1 needs temperature_publisher\.py, but it is not in .*/answer$"),
        (["src/pkg/temperature_publisher.py"], r"found it in .*/answer/src/pkg: give that folder"),
    ],
)
def test_a_missing_file_is_reported_with_what_was_found(
    publisher: Lesson, folder: Path, present: list[str], message: str
) -> None:
    for name in present:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).touch()
    with pytest.raises(SubmissionError, match=message):
        find_submission(publisher, folder, None)


def test_the_exercises_other_file_is_not_taken_for_a_misspelling(calculator: Lesson, folder: Path) -> None:
    (folder / "calculator_client.py").touch()
    with pytest.raises(SubmissionError) as caught:
        find_submission(calculator, folder, None)
    assert "calculator_server.py" in str(caught.value)
    assert "rename" not in str(caught.value)


def test_none_of_the_exercises_other_files_is_taken_for_a_misspelling(calculator: Lesson, folder: Path) -> None:
    server, client = calculator.files
    lesson = replace(calculator, files=(server, client, replace(client, name="calculator_sender.py")))
    for name in ("calculator_client.py", "calculator_sender.py"):
        (folder / name).touch()
    with pytest.raises(SubmissionError, match=r"i1\.3 needs calculator_server\.py, but it is not in .*/answer$"):
        find_submission(lesson, folder, None)


def test_a_missing_path_is_reported(publisher: Lesson, folder: Path) -> None:
    (folder / "temperature_publisher.py").touch()
    with pytest.raises(SubmissionError, match=r"no file or folder .*/temperature_publsher\.py \(found temperature_"):
        find_submission(publisher, folder / "temperature_publsher.py", None)


def test_a_missing_workspace_is_reported(publisher: Lesson, workspace: Workspace) -> None:
    with pytest.raises(SubmissionError, match=r"no workspace at .*/ws yet: `ros-tutor start i1\.1` creates it"):
        find_submission(publisher, None, workspace)


def test_an_exercise_not_started_is_reported(publisher: Lesson, launch: Lesson, workspace: Workspace) -> None:
    start(publisher, workspace)
    with pytest.raises(SubmissionError, match=r"launch/my_launch\.py does not exist; `ros-tutor start i2\.2`"):
        find_submission(launch, None, workspace)
    assert is_started(publisher, None, workspace)
    assert not is_started(launch, None, workspace)


def test_a_file_that_cannot_run_is_reported(publisher: Lesson, folder: Path, tmp_path: Path) -> None:
    path = folder / "temperature_publisher.py"
    path.mkdir()
    with pytest.raises(SubmissionError, match="is a folder, not a Python file"):
        find_submission(publisher, folder, None)
    path.rmdir()
    path.symlink_to(tmp_path / "nothing")
    with pytest.raises(SubmissionError, match="link to a file that does not exist"):
        find_submission(publisher, folder, None)
    path.unlink()
    os.mkfifo(path)
    with pytest.raises(SubmissionError, match="not a regular file"):
        find_submission(publisher, folder, None)


@pytest.mark.usefixtures("permissions_enforced")
def test_an_unreadable_file_is_reported(publisher: Lesson, folder: Path) -> None:
    (folder / "temperature_publisher.py").touch(mode=0o000)
    with pytest.raises(SubmissionError, match=r"cannot read .*temperature_publisher\.py: Permission denied"):
        find_submission(publisher, folder, None)
