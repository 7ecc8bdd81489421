"""What a command that was asked for a document writes when it cannot do its work."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.cli.conftest import Run
from tests.cli.fake_engine import FakeEngine
from tests.report.shape import assert_junit, assert_report_shape
from tutor.content import load_course

NEEDED = "temperature_publisher.py"


@pytest.fixture
def folder(home: Path) -> Path:
    """An empty folder."""
    folder = home / "handed in"
    folder.mkdir()
    return folder


@pytest.mark.parametrize("names", [(), ("temperature_pub.py",), ("notes.txt", "Temperature_Publisher.py")])
def test_a_document_says_what_was_looked_for_and_what_is_there(run: Run, folder: Path, names: tuple[str, ...]) -> None:
    for name in names:
        (folder / name).touch()
    result = run("check", "i1.1", folder, "--format", "json")
    document = json.loads(result.out)
    assert_report_shape(document)
    (exercise,) = document["exercises"]
    assert (result.code, document["verdict"], exercise["verdict"], exercise["submission"]) == (2, "error", "error", [])
    assert document["message"] == exercise["missing"]["message"]
    assert document["message"].startswith(f"i1.1 needs {NEEDED}, but ")
    assert exercise["missing"]["looked_for"] == [str(folder / NEEDED)]
    assert exercise["missing"]["found"] == sorted(names)
    assert {each["status"] for each in exercise["criteria"]} == {"error"}
    assert result.err == f"ros-tutor: {document['message']}\n"


def test_a_path_that_does_not_exist_and_a_workspace_that_is_not_there(run: Run, home: Path) -> None:
    result = run("check", "i1.1", "nope/x.py", "--format=json")
    (exercise,) = json.loads(result.out)["exercises"]
    assert (result.code, exercise["missing"]["looked_for"]) == (2, [str(home / "nope/x.py")])
    result = run("check", "i1.1", "--format", "json")
    (exercise,) = json.loads(result.out)["exercises"]
    assert exercise["missing"]["looked_for"] == [str(home / "ros_tutor_ws/src/my_package/my_package" / NEEDED)]
    assert "there is no workspace" in exercise["missing"]["message"]


def test_junit_and_markdown_say_it_too(run: Run, folder: Path) -> None:
    (folder / "other.py").touch()
    result = run("check", "i1.3", folder, "--format", "junit")
    root = ElementTree.fromstring(result.out)
    assert_junit(root)
    assert (result.code, root.get("failures"), root.get("errors")) == (2, "0", "4")
    assert "found there: other.py" in "".join(root.itertext())
    result = run("check", "i1.1", folder, "--format", "markdown")
    assert result.code == 2
    assert result.out.startswith("# ros-tutor: error\n\ni1.1 needs temperature\\_publisher.py, but it is not in ")
    assert "\nfound there: other.py\n" in result.out
    assert (run("check", "i1.1", folder).out, run("check", "i1.1", folder, "--format", "text").out) == ("", "")


@pytest.mark.parametrize("format", ["text", "json", "junit", "markdown"])
def test_an_older_report_in_the_output_file_is_replaced(run: Run, folder: Path, home: Path, format: str) -> None:
    (home / "report").write_text("passed")
    result = run("check", "i1.1", folder, "--format", format, "--output", "report")
    assert (result.code, result.out) == (2, "")
    text = (home / "report").read_text()
    assert "error" in text
    assert "passed" not in text


def test_check_all_with_nothing_to_judge_lists_every_exercise(run: Run, folder: Path) -> None:
    result = run("check", "all", folder, "--format", "json", "--criterion", "shutdown")
    document = json.loads(result.out)
    assert_report_shape(document)
    assert result.code == 2
    lessons = load_course().lessons
    assert [(each["id"], each["verdict"]) for each in document["exercises"]] == [
        (lesson.id, "error") for lesson in lessons if any(criterion.id == "shutdown" for criterion in lesson.criteria)
    ]
    assert all([c["id"] for c in each["criteria"]] == ["shutdown"] for each in document["exercises"])


@pytest.mark.parametrize(
    "words",
    [
        ("check", "i9.9", "--format", "json"),
        ("check", "i1.1", "--format", "json", "--criterion", "nope"),
        ("check", "--format", "json"),
        ("check", "i1.1", "--format=json", "--bogus"),
        ("check", "i1.1", "--format", "json", "--workspace", "nowhere"),
    ],
)
def test_wrong_usage_of_check_is_a_report_without_exercises(run: Run, words: tuple[str, ...]) -> None:
    result = run(*words)
    document = json.loads(result.out)
    assert_report_shape(document)
    assert (result.code, document["verdict"], document["exercises"]) == (2, "error", [])
    assert result.err == f"ros-tutor: {document['message']}\n"
    assert_junit(ElementTree.fromstring(run(*(word.replace("json", "junit") for word in words)).out))


@pytest.mark.parametrize(
    "words",
    [
        ("list", "--format", "json", "--workspace", "nowhere"),
        ("list", "--format", "json", "more"),
        ("checklist", "export", "--format", "json", "--workspace", "nowhere"),
        ("checklist", "--format", "json"),
    ],
)
def test_other_commands_write_an_error_document(run: Run, words: tuple[str, ...]) -> None:
    result = run(*words)
    document = json.loads(result.out)
    assert list(document) == ["schema", "exit_code", "message"]
    assert (document["schema"], document["exit_code"], result.code) == ("ros-tutor/error/1", 2, 2)
    assert result.err == f"ros-tutor: {document['message']}\n"


def test_no_document_is_written_unless_asked_for(run: Run, engine: FakeEngine, home: Path) -> None:
    for words in (("list", "more"), ("check", "i9.9"), ("start", "i9.9"), ("hint", "--format", "json", "i1.1")):
        assert run(*words).out == ""
    engine.raises = KeyboardInterrupt()
    run("start", "i1.1")
    assert run("check", "i1.1", "--format", "json").out == ""
    assert run("check", "i1.1", "--format", "json", "--output", "nowhere/report.json").code == 2
    assert not (home / "nowhere").exists()
