"""`ros-tutor check`: what is judged, the output, the exit codes, and the recorded progress."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.cli.conftest import Run
from tests.cli.fake_engine import FAILURE, FakeEngine
from tests.report.shape import assert_report_shape
from tutor.content import load_course
from tutor.errors import EngineError
from tutor.judge.verdict import fault, skipped
from tutor.tui.widgets.attempts import format_attempts
from tutor.workspace import Progress, Workspace

FILE = "ros_tutor_ws/src/my_package/my_package/temperature_publisher.py"


def progress(home: Path) -> Progress:
    return Workspace(home / "ros_tutor_ws").progress().read()


def test_a_pass_exits_0(run: Run, engine: FakeEngine) -> None:
    run("start", "i1.1")
    result = run("check", "i1.1")
    assert result.code == 0
    assert "i1.1 Sensor Publisher  PASSED  6 of 6 passed, bonus 1 of 1" in result.out
    assert result.err == ""


def test_a_failure_exits_1_and_says_what_to_do(run: Run, engine: FakeEngine) -> None:
    engine.verdicts = {"publishes": FAILURE, "range": skipped("not judged")}
    result = run("check", "i1.1", "--solution")
    assert result.code == 1
    for text in ("5 messages", "0 messages", "no spin: no callback ran", "call rclpy.spin(node)", "a line"):
        assert text in result.out


def test_a_missed_bonus_still_exits_0(run: Run, engine: FakeEngine) -> None:
    engine.verdicts = {"shutdown": FAILURE}
    assert run("check", "i1.1", "--solution").code == 0


def test_what_could_not_be_judged_exits_3(run: Run, engine: FakeEngine) -> None:
    engine.verdicts = {"rate": fault("no free domain", "close others")}
    result = run("check", "i1.1", "--solution")
    assert result.code == 3
    assert "no fault of your code" in result.out


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (EngineError("no ROS here", "run the doctor"), "ros-tutor: no ROS here; run the doctor\n"),
        (ZeroDivisionError("oh"), "ros-tutor: something went wrong in ros-tutor itself: ZeroDivisionError: oh (ROS_"),
    ],
)
def test_an_engine_error_is_one_line_and_exits_3(run: Run, engine: FakeEngine, error: Exception, message: str) -> None:
    engine.raises = error
    result = run("check", "i1.1", "--solution", "--format", "json")
    assert result.code == 3
    document = json.loads(result.out)
    assert_report_shape(document)
    assert (document["verdict"], document["exercises"]) == ("error", [])
    assert f"ros-tutor: {document['message']}\n" == result.err
    assert result.err.startswith(message)
    assert result.err.count("\n") == 1


def test_json_output_is_exactly_one_document(run: Run, engine: FakeEngine) -> None:
    engine.verdicts = {"publishes": FAILURE}
    result = run("check", "i1.1", "--solution", "--format", "json")
    document = json.loads(result.out)
    assert_report_shape(document)
    assert (document["verdict"], document["duration_s"]) == ("failed", 1.235)
    assert result.err == ""


def test_options_may_come_between_the_exercise_and_the_path(run: Run, engine: FakeEngine, home: Path) -> None:
    (home / "try.py").touch()
    for argv in (["--format", "json", "i1.1", "try.py"], ["i1.1", "--format", "json", "try.py"]):
        assert run("check", *argv).code == 0
        assert engine.calls[-1][0][0].files == {"temperature_publisher.py": home / "try.py"}
    assert run("start", "i1.1", "--force", "there").code == 0
    assert (home / "there" / "temperature_publisher.py").is_file()


def test_first_asks_the_engine_to_end_at_the_first_failure(run: Run, engine: FakeEngine) -> None:
    first_flags = []
    for more in ((), ("--first",)):
        assert run("check", "i1.1", "--solution", *more).code == 0
        first_flags.append(engine.first)
    assert first_flags == [False, True]
    because = "not judged, because the check ended at its first failure, `publishes`"
    engine.verdicts = {"publishes": FAILURE, "rate": skipped(because)}
    result = run("check", "i1.1", "--solution", "--first", "--format", "json")
    assert result.code == 1
    document = json.loads(result.out)
    assert_report_shape(document)
    (rate,) = (each for each in document["exercises"][0]["criteria"] if each["id"] == "rate")
    assert (rate["status"], rate["cause"]) == ("skipped", because)


def test_other_formats(run: Run, engine: FakeEngine) -> None:
    assert ElementTree.fromstring(run("check", "i1.1", "--solution", "--format", "junit").out).tag == "testsuites"
    assert run("check", "i1.1", "--solution", "--format", "markdown").out.startswith("# ros-tutor: passed\n")


def test_output_goes_to_a_file_and_stdout_stays_empty(run: Run, engine: FakeEngine, home: Path) -> None:
    result = run("check", "i1.1", "--solution", "--format", "json", "--output", "report.json")
    assert (result.code, result.out) == (0, "")
    assert "the report is in report.json" in result.err
    assert_report_shape(json.loads((home / "report.json").read_text()))
    assert [path.name for path in home.iterdir()] == ["report.json"]


def test_the_workspaces_own_file_is_judged_and_recorded(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    engine.verdicts = {"publishes": FAILURE}
    run("check", "i1.1")
    (submission,), only = engine.calls[-1]
    assert submission.files == {"temperature_publisher.py": home / FILE}
    assert only is None
    last = progress(home).of("i1.1").last
    assert last is not None
    assert last.verdict.value == "failed"
    assert "publishes" not in last.passed
    assert "rate" in last.passed

    run("check", "i1.1", FILE)
    assert len(progress(home).of("i1.1").attempts) == 2


def test_files_outside_the_workspace_are_judged_but_not_recorded(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    (home / "try.py").touch()
    run("check", "i1.1", "try.py")
    assert engine.calls[-1][0][0].files == {"temperature_publisher.py": home / "try.py"}
    run("check", "i1.1", "--solution")
    assert engine.calls[-1][0][0].files["temperature_publisher.py"].parent.name == "solution"
    assert progress(home).of("i1.1").attempts == ()


def test_a_check_never_creates_a_workspace(run: Run, engine: FakeEngine, home: Path) -> None:
    (home / "try.py").touch()
    assert run("check", "i1.1", "try.py").code == 0
    assert [path.name for path in home.iterdir()] == ["try.py"]


def test_only_the_selected_criteria_are_judged(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    run("check", "i1.1", "--criterion", "rate", "--criterion", "echo")
    assert engine.calls[-1][1] == frozenset({"rate", "echo"})
    kept = progress(home).of("i1.1")
    assert kept.best is None
    assert kept.last is not None
    assert kept.last.judged == ("echo", "rate")
    assert "2 of 6 met, last check passed" in run("list").out


def test_attempts_at_selected_criteria_say_nothing_about_the_others(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    lesson = load_course().find("i1.1")
    run("check", "i1.1", "--criterion", "rate")
    engine.verdicts["rate"] = FAILURE
    run("check", "i1.1", "--criterion", "rate")
    shown = format_attempts(lesson, progress(home).of("i1.1"), max_count=5).plain
    assert shown.count("not yet: rate  (only rate)") == 1
    assert "0 of 1" in shown
    assert "1 of 1" in shown
    assert "publishes" not in shown


def test_progress_that_cannot_be_saved_does_not_change_the_verdict(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    file = home / "ros_tutor_ws" / ".ros-tutor" / "progress.json"
    file.unlink()
    file.mkdir()
    result = run("check", "i1.1")
    assert result.code == 0
    assert "PASSED" in result.out
    assert "this check is not in your progress: cannot read" in result.err


def test_a_report_that_cannot_be_written_does_not_lose_the_progress(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    (home / "report").symlink_to(home / "no" / "such" / "folder")
    result = run("check", "i1.1", "--output", "report")
    assert result.code == 3
    assert "cannot write report: No such file or directory" in result.err
    assert len(progress(home).of("i1.1").attempts) == 1


def test_check_all_fails_if_an_exercise_was_not_started_and_says_so(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    run("start", "i2.1")
    result = run("check", "all")
    assert result.code == 1
    assert [submission.exercise for submission in engine.calls[-1][0]] == ["i1.1", "i2.1"]
    assert "i1.3 Calculator Service  FAILED\n  not started; `ros-tutor start i1.3` puts the skeleton" in result.out
    course = [lesson.id for lesson in load_course().lessons if not lesson.beyond]  # nobody has to start the others
    assert f"2 of {len(course)} exercises passed" in result.out
    assert result.err == ""
    assert progress(home).of("i1.3").attempts == ()

    document = json.loads(run("check", "all", "--format", "json").out)
    assert_report_shape(document)
    assert document["verdict"] == "failed"
    assert [exercise["id"] for exercise in document["exercises"]] == course
    by_id = {exercise["id"]: exercise for exercise in document["exercises"]}
    assert (by_id["i1.3"]["verdict"], by_id["i1.3"]["submission"]) == ("failed", [])
    assert {each["cause"] for each in by_id["i1.3"]["criteria"]} == {"not started"}
    assert by_id["i1.3"]["missing"] == {
        "message": "not started",
        "looked_for": [str(home / "ros_tutor_ws/src/my_package/my_package/calculator_server.py")],
        "found": [
            *("minimal_publisher.py", "minimal_subscriber.py", "parameterized_publisher.py", "temperature_publisher.py")
        ],
    }
    assert by_id["i1.1"]["verdict"] == "passed"


def test_check_all_passes_if_every_exercise_passes(run: Run, engine: FakeEngine) -> None:
    for lesson in load_course().lessons:
        run("start", lesson.id)
    result = run("check", "all")
    assert (result.code, result.err) == (0, "")


def test_a_bonus_alone_does_not_pass_an_exercise_that_was_not_started(run: Run, engine: FakeEngine) -> None:
    run("start", "i1.1")
    result = run("check", "all", "--criterion", "shutdown", "--format", "json")
    assert result.code == 1
    for exercise in json.loads(result.out)["exercises"]:
        assert [each["id"] for each in exercise["criteria"]] == ["shutdown"]


def test_check_all_in_a_folder(run: Run, engine: FakeEngine, home: Path) -> None:
    folder = home / "handed in"
    folder.mkdir()
    result = run("check", "all", folder)
    assert result.code == 2
    assert "there is nothing to judge in" in result.err

    (folder / "temperature_publisher.py").touch()
    (folder / "calculator_client.py").touch()
    result = run("check", "all", folder)
    assert result.code == 1
    assert [submission.exercise for submission in engine.calls[-1][0]] == ["i1.1"]
    assert "i1.3 needs calculator_server.py" in " ".join(result.out.split())


def test_check_all_solutions(run: Run, engine: FakeEngine) -> None:
    assert run("check", "ALL", "--solution").code == 0
    assert [submission.exercise for submission in engine.calls[-1][0]] == [
        lesson.id for lesson in load_course().lessons
    ]


def test_check_all_with_one_criterion_judges_the_exercises_that_have_it(run: Run, engine: FakeEngine) -> None:
    run("check", "all", "--solution", "--criterion", "sensor-name")
    assert [submission.exercise for submission in engine.calls[-1][0]] == ["i1.1"]
