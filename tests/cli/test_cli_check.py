"""`ros-tutor check`: what is judged, what is written where, the exit codes, and what is remembered."""

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
from tutor.tui.widgets.attempts import history
from tutor.workspace import Progress, Workspace

FILE = "ros_tutor_ws/src/my_package/my_package/temperature_publisher.py"


def progress(home: Path) -> Progress:
    return Workspace(home / "ros_tutor_ws").progress().read()


def test_passed_is_0(run: Run, engine: FakeEngine) -> None:
    run("start", "i1.1")
    ran = run("check", "i1.1")
    assert ran.code == 0
    assert "i1.1 Sensor Publisher  PASSED  6 of 6 passed, bonus 1 of 1" in ran.out
    assert ran.err == ""


def test_failed_is_1_and_says_what_to_do(run: Run, engine: FakeEngine) -> None:
    engine.verdicts = {"publishes": FAILURE, "range": skipped("not judged")}
    ran = run("check", "i1.1", "--solution")
    assert ran.code == 1
    for text in ("5 messages", "0 messages", "no spin: no callback ran", "call rclpy.spin(node)", "a line"):
        assert text in ran.out


def test_a_missed_bonus_is_still_0(run: Run, engine: FakeEngine) -> None:
    engine.verdicts = {"shutdown": FAILURE}
    assert run("check", "i1.1", "--solution").code == 0


def test_what_could_not_be_judged_is_3(run: Run, engine: FakeEngine) -> None:
    engine.verdicts = {"rate": fault("no free domain", "close others")}
    ran = run("check", "i1.1", "--solution")
    assert ran.code == 3
    assert "no fault of your code" in ran.out


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (EngineError("no ROS here", "run the doctor"), "ros-tutor: no ROS here; run the doctor\n"),
        (ZeroDivisionError("oh"), "ros-tutor: something went wrong in ros-tutor itself: ZeroDivisionError: oh (ROS_"),
    ],
)
def test_a_fault_of_the_engine_is_3_and_one_line(run: Run, engine: FakeEngine, error: Exception, message: str) -> None:
    engine.raises = error
    ran = run("check", "i1.1", "--solution", "--format", "json")
    assert (ran.code, ran.out) == (3, "")
    assert ran.err.startswith(message)
    assert ran.err.count("\n") == 1


def test_json_is_one_document_and_nothing_more(run: Run, engine: FakeEngine) -> None:
    engine.verdicts = {"publishes": FAILURE}
    ran = run("check", "i1.1", "--solution", "--format", "json")
    document = json.loads(ran.out)
    assert_report_shape(document)
    assert (document["verdict"], document["duration_s"]) == ("failed", 1.235)
    assert ran.err == ""


def test_options_may_stand_between_the_exercise_and_the_path(run: Run, engine: FakeEngine, home: Path) -> None:
    (home / "try.py").touch()
    for argv in (["--format", "json", "i1.1", "try.py"], ["i1.1", "--format", "json", "try.py"]):
        assert run("check", *argv).code == 0
        assert engine.asked[-1][0][0].files == {"temperature_publisher.py": home / "try.py"}
    assert run("start", "i1.1", "--force", "there").code == 0
    assert (home / "there" / "temperature_publisher.py").is_file()


def test_first_asks_the_engine_to_end_at_the_first_failure(run: Run, engine: FakeEngine) -> None:
    wanted = []
    for more in ((), ("--first",)):
        assert run("check", "i1.1", "--solution", *more).code == 0
        wanted.append(engine.first)
    assert wanted == [False, True]
    because = "not judged, because the check ended at its first failure, `publishes`"
    engine.verdicts = {"publishes": FAILURE, "rate": skipped(because)}
    ran = run("check", "i1.1", "--solution", "--first", "--format", "json")
    assert ran.code == 1
    document = json.loads(ran.out)
    assert_report_shape(document)
    (rate,) = (each for each in document["exercises"][0]["criteria"] if each["id"] == "rate")
    assert (rate["status"], rate["cause"]) == ("skipped", because)


def test_other_formats(run: Run, engine: FakeEngine) -> None:
    assert ElementTree.fromstring(run("check", "i1.1", "--solution", "--format", "junit").out).tag == "testsuites"
    assert run("check", "i1.1", "--solution", "--format", "markdown").out.startswith("# ros-tutor: passed\n")


def test_output_goes_to_a_file_and_stdout_stays_empty(run: Run, engine: FakeEngine, home: Path) -> None:
    ran = run("check", "i1.1", "--solution", "--format", "json", "--output", "report.json")
    assert (ran.code, ran.out) == (0, "")
    assert "the report is in report.json" in ran.err
    assert_report_shape(json.loads((home / "report.json").read_text()))
    assert [path.name for path in home.iterdir()] == ["report.json"]


def test_the_workspaces_own_file_is_judged_and_remembered(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    engine.verdicts = {"publishes": FAILURE}
    run("check", "i1.1")
    (submission,), only = engine.asked[-1]
    assert submission.files == {"temperature_publisher.py": home / FILE}
    assert only is None
    last = progress(home).of("i1.1").last
    assert last is not None
    assert last.verdict.value == "failed"
    assert "publishes" not in last.passed
    assert "rate" in last.passed

    run("check", "i1.1", FILE)
    assert len(progress(home).of("i1.1").attempts) == 2


def test_what_is_not_the_workspaces_own_is_judged_but_not_remembered(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    (home / "try.py").touch()
    run("check", "i1.1", "try.py")
    assert engine.asked[-1][0][0].files == {"temperature_publisher.py": home / "try.py"}
    run("check", "i1.1", "--solution")
    assert engine.asked[-1][0][0].files["temperature_publisher.py"].parent.name == "solution"
    assert progress(home).of("i1.1").attempts == ()


def test_a_check_never_makes_a_workspace(run: Run, engine: FakeEngine, home: Path) -> None:
    (home / "try.py").touch()
    assert run("check", "i1.1", "try.py").code == 0
    assert [path.name for path in home.iterdir()] == ["try.py"]


def test_some_criteria_only(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    run("check", "i1.1", "--criterion", "rate", "--criterion", "echo")
    assert engine.asked[-1][1] == frozenset({"rate", "echo"})
    kept = progress(home).of("i1.1")
    assert kept.best is None
    assert kept.last is not None
    assert kept.last.judged == ("echo", "rate")
    assert "2 of 6 met, last check passed" in run("list").out


def test_attempts_at_some_criteria_say_nothing_of_the_others(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    lesson = load_course().find("i1.1")
    run("check", "i1.1", "--criterion", "rate")
    engine.verdicts["rate"] = FAILURE
    run("check", "i1.1", "--criterion", "rate")
    shown = history(lesson, progress(home).of("i1.1"), most=5).plain
    assert shown.count("not yet: rate  (only rate)") == 1
    assert "0 of 1" in shown
    assert "1 of 1" in shown
    assert "publishes" not in shown


def test_progress_that_cannot_be_kept_does_not_change_the_verdict(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    file = home / "ros_tutor_ws" / ".ros-tutor" / "progress.json"
    file.unlink()
    file.mkdir()
    ran = run("check", "i1.1")
    assert ran.code == 0
    assert "PASSED" in ran.out
    assert "this check is not in your progress: cannot read" in ran.err


def test_a_report_that_cannot_be_written_does_not_lose_the_progress(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    (home / "report").symlink_to(home / "no" / "such" / "folder")
    ran = run("check", "i1.1", "--output", "report")
    assert ran.code == 3
    assert "cannot write report: No such file or directory" in ran.err
    assert len(progress(home).of("i1.1").attempts) == 1


def test_all_fails_where_something_was_not_started_and_says_so(run: Run, engine: FakeEngine, home: Path) -> None:
    run("start", "i1.1")
    run("start", "i2.1")
    ran = run("check", "all")
    assert ran.code == 1
    assert [submission.exercise for submission in engine.asked[-1][0]] == ["i1.1", "i2.1"]
    assert "i1.3 Calculator Service  FAILED\n  not started; `ros-tutor start i1.3` puts the skeleton" in ran.out
    assert f"2 of {len(load_course().lessons)} exercises passed" in ran.out
    assert ran.err == ""
    assert progress(home).of("i1.3").attempts == ()

    document = json.loads(run("check", "all", "--format", "json").out)
    assert_report_shape(document)
    assert document["verdict"] == "failed"
    assert [exercise["id"] for exercise in document["exercises"]] == [lesson.id for lesson in load_course().lessons]
    by_id = {exercise["id"]: exercise for exercise in document["exercises"]}
    assert (by_id["i1.3"]["verdict"], by_id["i1.3"]["submission"]) == ("failed", [])
    assert {each["cause"] for each in by_id["i1.3"]["criteria"]} == {"not started"}
    assert by_id["i1.1"]["verdict"] == "passed"


def test_all_passes_where_everything_is_there_and_passes(run: Run, engine: FakeEngine) -> None:
    for lesson in load_course().lessons:
        run("start", lesson.id)
    ran = run("check", "all")
    assert (ran.code, ran.err) == (0, "")


def test_a_bonus_alone_does_not_pass_what_was_not_started(run: Run, engine: FakeEngine) -> None:
    run("start", "i1.1")
    ran = run("check", "all", "--criterion", "shutdown", "--format", "json")
    assert ran.code == 1
    for exercise in json.loads(ran.out)["exercises"]:
        assert [each["id"] for each in exercise["criteria"]] == ["shutdown"]


def test_all_in_a_folder(run: Run, engine: FakeEngine, home: Path) -> None:
    folder = home / "handed in"
    folder.mkdir()
    ran = run("check", "all", folder)
    assert ran.code == 2
    assert "there is nothing to judge in" in ran.err

    (folder / "temperature_publisher.py").touch()
    (folder / "calculator_client.py").touch()
    ran = run("check", "all", folder)
    assert ran.code == 1
    assert [submission.exercise for submission in engine.asked[-1][0]] == ["i1.1"]
    assert "i1.3 needs calculator_server.py" in " ".join(ran.out.split())


def test_all_solutions(run: Run, engine: FakeEngine) -> None:
    assert run("check", "ALL", "--solution").code == 0
    assert [submission.exercise for submission in engine.asked[-1][0]] == [
        lesson.id for lesson in load_course().lessons
    ]


def test_all_with_one_criterion_judges_the_exercises_that_have_it(run: Run, engine: FakeEngine) -> None:
    run("check", "all", "--solution", "--criterion", "sensor-name")
    assert [submission.exercise for submission in engine.asked[-1][0]] == ["i1.1"]
