"""The commands of a learner: list, start, hint, solution, checklist, doctor."""

from __future__ import annotations

import json
import sys
import types
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from tests.cli.conftest import Run
from tests.cli.fake_engine import FAILURE, FakeEngine
from tutor.workspace import Workspace


def line_of(text: str, exercise: str) -> str:
    return next(line for line in text.splitlines() if line.startswith(exercise))


def test_list_without_a_workspace_shows_everything_as_not_started(run: Run, home: Path) -> None:
    result = run("list")
    assert result.code == 0
    assert "Sensor Publisher" in line_of(result.out, "i1.1")
    assert "easy" in line_of(result.out, "i1.1")
    assert line_of(result.out, "i1.1").endswith("not started")
    assert "Next: ros-tutor start i1.1" in result.out
    assert "there is no workspace yet" in result.err
    assert list(home.iterdir()) == []


def test_list_follows_the_learners_progress(run: Run, engine: FakeEngine) -> None:
    run("start", "i1.1")
    assert line_of(run("list").out, "i1.1").endswith("· started")

    engine.verdicts = {"publishes": FAILURE}
    run("check", "i1.1")
    line = line_of(run("list").out, "i1.1")
    assert "✗ not passed yet" in line
    assert "5 of 6 met, last check failed" in line

    engine.verdicts = {}
    run("check", "i1.1")
    engine.verdicts = {"publishes": FAILURE}
    run("check", "i1.1")
    result = run("list")
    assert "✓ passed" in line_of(result.out, "i1.1")
    assert "last check failed" in line_of(result.out, "i1.1")
    assert "1 of " in result.out
    assert result.err == ""


def test_start_says_where_the_workspace_and_the_files_are(run: Run, home: Path) -> None:
    result = run("start", "I1_1")
    assert result.code == 0
    assert f"Created your workspace: {home}/ros_tutor_ws" in result.out
    file = home / "ros_tutor_ws/src/my_package/my_package/temperature_publisher.py"
    assert file.is_file()
    assert "ros_tutor_ws/src/my_package/my_package/temperature_publisher.py" in result.out
    assert "ros-tutor check i1.1" in result.out

    again = run("start", "i1.1")
    assert again.code == 0
    assert "already there" in again.out
    assert "Created" not in again.out


def test_start_never_overwrites_without_force(run: Run, home: Path) -> None:
    run("start", "i1.1")
    file = home / "ros_tutor_ws/src/my_package/my_package/temperature_publisher.py"
    skeleton = file.read_text()
    file.write_text("my work")

    result = run("start", "i1.1")
    assert result.code == 2
    assert "--force" in result.err
    assert file.read_text() == "my work"

    result = run("start", "i1.1", "--force")
    assert result.code == 0
    assert file.read_text() == skeleton
    assert file.with_name("temperature_publisher.py.~1~").read_text() == "my work"
    assert "temperature_publisher.py.~1~" in result.out


def test_start_into_a_folder_creates_no_workspace(run: Run, home: Path) -> None:
    result = run("start", "i1.3", "answers")
    assert result.code == 0
    assert {path.name for path in (home / "answers").iterdir()} == {"calculator_server.py", "calculator_client.py"}
    assert [path.name for path in home.iterdir()] == ["answers"]
    assert "ros-tutor check i1.3 answers" in result.out


def test_hints_come_one_by_one(run: Run) -> None:
    run("start", "i2.1")
    shown = [run("hint", "i2.1") for _ in range(4)]
    assert [result.out.splitlines()[0] for result in shown] == [f"Hint {n} of 3" for n in (1, 2, 3, 3)]
    assert shown[2].out == shown[3].out
    assert shown[2].err == ""
    assert "that was the last hint" in shown[3].err
    every = run("hint", "i2.1", "--all").out
    assert all(result.out in every for result in shown)


def test_without_a_workspace_hint_says_why_it_always_shows_the_first(run: Run, home: Path) -> None:
    for _ in range(2):
        result = run("hint", "i2.1")
        assert result.code == 0
        assert result.out.startswith("Hint 1 of 3\n")
        assert "cannot remember which hints you have seen" in result.err
    assert list(home.iterdir()) == []


def test_a_solution_is_runnable_python_on_stdout(run: Run) -> None:
    one = run("solution", "i1.1")
    assert (one.code, one.err) == (0, "")
    compile(one.out, "solution", "exec")
    assert "# ---" not in one.out
    two = run("solution", "i1.3")
    assert two.out.startswith("# --- calculator_server.py ---\n")
    assert "\n# --- calculator_client.py ---\n" in two.out


def test_the_checklist_is_ticked_and_exported(run: Run, home: Path) -> None:
    run("start", "i1.1")
    result = run("checklist", "tick", "timers", "log-levels")
    assert result.code == 0
    assert "[x] timers" in result.out
    run("checklist", "untick", "log-levels")
    result = run("checklist")
    assert "[x] timers" in result.out
    assert "[ ] log-levels" in result.out

    assert "- [x] " in run("checklist", "export").out
    result = run("checklist", "export", "--format", "json", "--output", "list.json")
    assert (result.code, result.out) == (0, "")
    groups = json.loads((home / "list.json").read_text())["groups"]
    assert {item["id"] for group in groups for item in group["items"] if item["ticked"]} == {"timers"}
    assert run("checklist", "export", "--format", "html").out.startswith("<!DOCTYPE html>")
    run("checklist", "export", "--output", "page.html")
    assert (home / "page.html").read_text().startswith("<!DOCTYPE html>")


def test_evidence_is_what_holds_for_the_file_as_it_is(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    assert "i1.1" not in run("checklist").out
    run("check", "i1.1")
    shown = run("checklist").out
    timers = "Call a function at a fixed period with a timer"
    assert f"{timers}  (i1.1 rate passed, today)\n" in shown
    assert "End a node cleanly when someone presses Ctrl+C\n" in shown  # main() is the skeleton's

    node = Workspace(home / "ros_tutor_ws").path_of("temperature_publisher.py")
    written = node.read_text()
    node.write_text(f"{written}# changed\n")
    assert f"{timers}  (i1.1 rate passed today, since changed)\n" in run("checklist").out
    assert ", since changed |" in run("checklist", "export").out
    node.write_text(written)
    assert f"{timers}  (i1.1 rate passed, today)\n" in run("checklist").out

    # An ending of one's own, and a failure.
    node.write_text(written.replace("        node.destroy_node()\n", ""))
    engine.verdicts = {"rate": FAILURE}
    run("check", "i1.1")
    shown = run("checklist").out
    assert "rate passed" not in shown
    assert "End a node cleanly when someone presses Ctrl+C  (i1.1 shutdown passed, today)\n" in shown


@pytest.mark.parametrize(
    ("seen", "word"),
    [
        ((), "passed,"),
        (("hint", "i1.1"), "passed with hints,"),
        (("solution", "i1.1"), "passed with solution,"),
        (("diff", "i1.1", "--solution"), "passed with solution,"),
    ],
)
def test_what_was_seen_before_the_pass_is_said_in_one_word(run: Run, engine: FakeEngine, seen: Any, word: str) -> None:
    run("start", "i1.1")
    if seen:
        run(*seen)
    run("check", "i1.1")
    run("solution", "i1.1")  # too late to matter
    assert f"(i1.1 rate {word} today)" in run("checklist").out
    assert f"| {word} 2" in run("checklist", "export").out


@dataclass(frozen=True)
class Finding:
    name: str
    ok: bool | None
    text: str
    hint: str


@pytest.mark.parametrize(("ok", "code", "word"), [(True, 0, "✓ ok"), (None, 0, "! warning"), (False, 3, "✗ wrong")])
def test_the_doctor_prints_each_finding_with_its_hint(
    run: Run, monkeypatch: pytest.MonkeyPatch, ok: bool | None, code: int, word: str
) -> None:
    doctor = types.ModuleType("tutor.doctor")
    doctor.examine = lambda workspace: (Finding("loopback", ok, "it is up", "do this"),)  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "tutor.doctor", doctor)
    result = run("doctor")
    assert result.code == code
    assert result.out.startswith(word)
    assert ("fix: do this" in result.out) == (ok is not True)


def test_damaged_progress_is_reported_once_and_set_aside(run: Run, home: Path) -> None:
    run("start", "i1.1")
    folder = home / "ros_tutor_ws" / ".ros-tutor"
    (folder / "progress.json").write_text("{")
    result = run("list")
    assert result.code == 0
    assert result.err.count("\n") == 1
    assert "the old one is kept as" in result.err
    assert run("list").err == ""
    assert len(list(folder.glob("progress.json.damaged-*"))) == 1


def test_a_system_is_handed_over_answered_and_exchanged(run: Run, home: Path, engine: FakeEngine) -> None:
    assert run("answer", "b1.7").code == 2
    assert run("start", "b1.7").code == 0
    report = home / "ros_tutor_ws/src/my_package/launch/courier_report.yaml"

    choices = run("answer", "b1.7")  # nobody can be asked: the choices are listed
    assert choices.code == 0
    assert "qos" in line_of(choices.out, "  1  ")
    assert "courier_planner.py" in choices.out
    assert "say where, too" in run("answer", "b1.7", "qos").err
    assert "none of the choices" in run("answer", "b1.7", "magic", "courier_driver.py").err

    number = next(line.split()[0] for line in choices.out.splitlines() if line.endswith("courier_driver.py"))
    by_number = run("answer", "b1.7", "1", number)
    answered = run("answer", "b1.7", "qos", "courier_driver.py")
    assert by_number.out == answered.out
    assert "the QoS of the two ends of a topic does not match, in courier_driver.py" in answered.out
    assert "where: courier_driver.py" in report.read_text()
    assert "+what: qos" in run("diff", "b1.7").out

    run("check", "b1.7")
    another = run("start", "b1.7", "--another")
    assert "1 of 6 faults found and repaired" in another.out
    assert "already there" not in another.out  # it would say where the fault is not
    assert "nothing differs" in run("diff", "b1.7").err
    assert "what:\n" in report.read_text()
    assert "there is only one of it" in run("start", "i1.1", "--another").err
    assert "nothing to answer" in run("answer", "i1.1").err


def test_the_solution_is_that_of_the_fault_handed_over(run: Run, home: Path) -> None:
    run("start", "b1.7")
    report = (home / "ros_tutor_ws/src/my_package/launch/courier_report.yaml").read_text()
    case = next(line for line in report.splitlines() if line.startswith("case:"))
    assert f"\n{case}\n" in run("solution", "b1.7").out
