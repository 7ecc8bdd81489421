"""What autograders write, one document for each learner: Gradescope, Classroom 50, check50."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.grade import made
from tests.grade.schemas import CHECK50, CHECK50_ERROR, CLASSROOM50, GRADESCOPE, assert_valid
from tutor.errors import UsageError
from tutor.grade.formats import files, write
from tutor.grade.formats.classroom50 import result_document
from tutor.grade.formats.gradescope import results_document
from tutor.grade.gradebook import Gradebook
from tutor.grade.points import Points
from tutor.grade.results import Result, ResultFolder

FORMATS = ("gradescope", "classroom50", "check50")
ENVIRON = {
    "CLASSROOM": "robotics",
    "ASSIGNMENT": "week-1",
    "ASSIGNMENT_TYPE": "individual",
    "OWNER": "ada",
    "USERNAME": "ada",
    "SUBMISSION_TAG": "submit/2026-11-21T17-59-00Z-a1b2c3d",
    "COMMIT_URL": "https://github.com/x/robotics-week-1-ada/commit/a1b2c3d",
    "RELEASE_URL": "https://github.com/x/robotics-week-1-ada/releases/tag/submit%2F2026",
}


def documents(format: str, gradebook: Gradebook | None = None) -> dict[str, Any]:
    return {path: json.loads(text) for path, text in files(gradebook or made.gradebook(), format).items()}


def points(tmp_path: Path, text: str) -> Points:
    (tmp_path / "points.toml").write_text(text, encoding="utf-8")
    return Points.read(tmp_path / "points.toml", made.course())


# --- all of them ---


@pytest.mark.parametrize("format", FORMATS)
def test_no_file_of_a_learner_names_another(format: str) -> None:
    for path, document in documents(format).items():
        text = json.dumps(document, ensure_ascii=False)
        for learner in made.LEARNERS:
            if not path.startswith(f"{learner.id}/"):
                words = (learner.name, learner.email, f'"{learner.id}"', learner.name.split("\n")[0][:12])
                assert not [word for word in words if word in text], path


@pytest.mark.parametrize("format", FORMATS)
def test_steps_only_if_learners_may_know_them(format: str) -> None:
    assert any(made.STEP in text for text in files(made.gradebook(), format).values())
    for text in files(made.gradebook(steps=False), format).values():
        assert made.STEP not in text
        assert "next step" not in text
        assert "ros-tutor explain" not in text


@pytest.mark.parametrize("format", FORMATS)
def test_nothing_from_a_submission_controls_a_terminal(format: str) -> None:
    for text in files(made.gradebook(), format).values():
        assert all(character.isprintable() or character == "\n" for character in text)
        assert "\\u001b" not in text


@pytest.mark.parametrize("format", FORMATS)
def test_the_files_lie_beside_the_results_and_are_none(format: str, tmp_path: Path) -> None:
    folder = ResultFolder(tmp_path)
    for result in made.whole_class():
        folder.save(result)
    written = write(made.gradebook(), format, tmp_path)
    assert all(path.is_file() for path in written)
    assert len(list(folder)) == len(made.whole_class())


# --- Gradescope ---


def test_gradescope_gets_a_score_and_a_test_for_each_criterion() -> None:
    found = documents("gradescope")
    assert set(found) == {f"{learner.id}/results.json" for learner in made.LEARNERS}
    for document in found.values():
        assert_valid(document, GRADESCOPE)
        assert document["output_format"] == document["test_output_format"] == document["test_name_format"] == "text"
    ada, brian = found["ada/results.json"], found["brian/results.json"]
    assert ada["score"] == 20.0
    assert {test["status"] for test in ada["tests"]} == {"passed"}
    assert brian["score"] == 11.67
    assert len(brian["tests"]) == sum(len(made.lesson(exercise).criteria) for exercise in made.EXERCISES)
    publishes, failed, *_ = brian["tests"]
    assert (publishes["status"], publishes["score"], publishes["max_score"]) == ("passed", 1.67, 1.67)
    assert (failed["status"], failed["score"]) == ("failed", 0.0)
    assert made.RATE.cause in failed["output"]
    assert "my_node.py" in failed["output"]


def test_gradescope_says_what_was_looked_for() -> None:
    document = results_document([made.missing(made.ADA)], Points())
    assert document["score"] == 0.0
    assert "temperature_publisher.py" in document["output"]
    assert "homework (1).docx" in document["output"]
    assert "Autograder error" not in json.dumps(document)


def test_gradescope_shows_no_total_while_something_is_unjudged() -> None:
    document = results_document([made.passing(made.CHLOE), made.unjudged(made.CHLOE, "i2.1")], Points())
    assert_valid(document, GRADESCOPE)
    assert document["score"] == 10.0
    told, hidden, *tests = document["tests"]
    assert (told["name"], told["visibility"]) == ("Autograder error", "visible")
    assert hidden["visibility"] == "hidden"
    assert made.FAULT.cause in hidden["output"]
    assert made.FAULT.cause not in told["output"]
    assert [test for test in tests if test["name"].startswith("i1.1") and "score" in test]
    assert not [test for test in tests if test["name"].startswith("i2.1") and "score" in test]


def test_gradescope_without_any_verdict() -> None:
    document = results_document([made.not_started(made.DEV)], Points())
    assert_valid(document, GRADESCOPE)
    assert [test["visibility"] for test in document["tests"]] == ["visible", "hidden"]


def test_gradescope_counts_bonus_points(tmp_path: Path) -> None:
    worth = points(tmp_path, '["i1.1"]\npoints = 6\nbonus = 1\n')
    document = results_document([made.passing(made.ADA)], worth)
    assert document["score"] == 7.0
    assert document["tests"][-1]["max_score"] == 1.0
    assert "(bonus)" in document["tests"][-1]["name"]


# --- Classroom 50 ---


def test_classroom50_gets_whole_points() -> None:
    found = documents("classroom50")
    assert set(found) == {f"{learner.id}/result.json" for learner in made.LEARNERS}
    for document in found.values():
        assert_classroom50(document)
    assert (found["ada/result.json"]["score"], found["ada/result.json"]["max-score"]) == (60, 60)
    assert (found["brian/result.json"]["score"], found["brian/result.json"]["max-score"]) == (35, 60)
    assert found["dev/result.json"]["max-score"] == 0, "what a fault left unjudged counts neither way"


def assert_classroom50(document: Any) -> None:
    """Fail unless Classroom 50's `validate_result` takes the document."""
    assert_valid(document, CLASSROOM50)
    assert document["score"] <= document["max-score"] == sum(test["max-score"] for test in document["tests"])
    assert all(test["score"] <= test["max-score"] for test in document["tests"])


def test_classroom50_takes_its_identity_from_the_environment() -> None:
    document = result_document([made.passing(made.ADA)], Points(), ENVIRON)
    assert_classroom50(document)
    assert (document["classroom"], document["assignment"], document["owner"]) == ("robotics", "week-1", "ada")
    assert document["submission"] == ENVIRON["SUBMISSION_TAG"]
    assert document["review"] == ENVIRON["COMMIT_URL"], "without a REVIEW_URL"
    assert document["graded_at"] == "2026-11-21T18:03:04Z"
    for name in ("CLASSROOM", "SUBMISSION_TAG", "RELEASE_URL"):
        with pytest.raises(UsageError, match=name):
            result_document([made.passing(made.ADA)], Points(), {**ENVIRON, name: ""})


def test_classroom50_keeps_points_that_are_whole(tmp_path: Path) -> None:
    criteria = [criterion.id for criterion in made.lesson("i1.1").criteria if not criterion.bonus]
    weights = "\n".join(f"{name} = 2" for name in criteria)
    worth = points(tmp_path, f'["i1.1"]\npoints = {2 * len(criteria)}\n["i1.1".criteria]\n{weights}\n')
    document = result_document([made.failing(made.BRIAN)], worth, ENVIRON)
    assert (document["score"], document["max-score"]) == (2, 2 * len(criteria))


@pytest.mark.parametrize(
    ("result", "score"),
    [
        (made.passing(made.ADA), 6),
        (made.passing(made.ADA, bonus=False), 6),
        (made.failing(made.BRIAN), 1),
    ],
)
def test_classroom50_has_no_more_than_the_maximum_and_no_failed_bonus(
    result: Result, score: int, tmp_path: Path
) -> None:
    document = result_document([result], points(tmp_path, '["i1.1"]\npoints = 6\nbonus = 2\n'), ENVIRON)
    assert_classroom50(document)
    assert (document["score"], document["max-score"]) == (score, 6)
    assert not [test for test in document["tests"] if "bonus" in test["test-name"] and not test["passed"]]


def test_classroom50_with_odd_points(tmp_path: Path) -> None:
    document = result_document([made.passing(made.ADA)], points(tmp_path, '["i1.1"]\npoints = 3.14159\n'), ENVIRON)
    assert_classroom50(document)
    assert document["score"] == document["max-score"]


# --- check50 ---


def test_check50_reads_each_exercise() -> None:
    found = documents("check50")
    assert set(found) == {f"{result.learner.id}/{result.exercise}.check50.json" for result in made.whole_class()}
    for path, document in found.items():
        assert_valid(document, CHECK50_ERROR if path.startswith("dev/") else CHECK50)
        for result in document.get("results", ()):
            assert (result["cause"] is None) == (result["passed"] is True)
            assert ("expected" in (result["cause"] or {})) == ("actual" in (result["cause"] or {}))
    passed, failed, same, skipped, *_ = found["brian/i1.1.check50.json"]["results"]
    assert [each["passed"] for each in (passed, failed, same, skipped)] == [True, False, False, None]
    assert (failed["cause"]["rationale"], failed["cause"]["help"]) == (made.RATE.cause, made.STEP)
    assert failed["cause"]["actual"] == made.RATE.observed
    assert failed["log"] == list(made.RATE.evidence)
    assert same["data"]["same_as"] == failed["name"]


def test_check50_could_not_check_is_not_failed() -> None:
    found = documents("check50")
    unjudged = found["chloe/i2.1.check50.json"]["results"][1]
    assert unjudged["passed"] is None
    assert unjudged["cause"]["error"]["value"] == made.FAULT.cause
    assert {result["passed"] for result in found["chloe/i1.1.check50.json"]["results"]} == {False}, "nothing handed in"
