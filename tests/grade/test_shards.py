"""A class in parts, on several machines: together they are what one machine would have made."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from tests.grade import made
from tutor.cli import main
from tutor.grade import grading
from tutor.grade.grading import LocalExecutor
from tutor.grade.results import Result, ResultFolder, encode
from tutor.grade.unit import OnEvent, Outcome, Unit

FILES = {"i1.1": "temperature_publisher.py", "i1.2": "message_stats.py"}
LEARNERS = ("ada", "brian", "chloé", "dev", "eve", "mallory", "neil")


class MadeResults(LocalExecutor):
    """Runs no code: of every second learner's submissions, it says that they passed."""

    async def run(self, unit: Unit, on_event: OnEvent) -> Outcome:
        place = LEARNERS.index(unit.key.split("/")[0])
        result = (made.failing if place % 2 else made.passing)(made.ADA, unit.exercise)
        return Outcome(result.report, cpu_s=1.0 + place)


@pytest.fixture(autouse=True)
def _no_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grading, "LocalExecutor", MadeResults)


@pytest.fixture
def a_class(tmp_path: Path) -> Path:
    folder = tmp_path / "class"
    for learner in LEARNERS:
        for file in FILES.values():
            (folder / learner).mkdir(parents=True, exist_ok=True)
            (folder / learner / file).write_text(f"# {learner}\n")
    (folder / "eve" / FILES["i1.2"]).rename(folder / "eve" / "message-stats (1).txt")
    return folder


def grade(*words: str | Path) -> int:
    return main(["grade", *map(str, words)])


def documents(folder: Path) -> dict[str, object]:
    """Return the results in a folder without their times."""
    found = {str(path.relative_to(folder)): json.loads(path.read_text()) for path in folder.rglob("*.json")}
    return {name: {**document, "graded_at": ""} for name, document in found.items()}


@pytest.mark.parametrize("parts", [1, 3, 20])
def test_all_shards_together_are_the_whole(
    a_class: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], parts: int
) -> None:
    whole, collected = tmp_path / "whole", tmp_path / "collected"
    assert grade(a_class, "--no-isolation", "--output", whole, "--format", "csv") == 0
    report = capsys.readouterr().out
    shards = [tmp_path / f"shard-{part}" for part in range(1, parts + 1)]
    for part, shard in enumerate(shards, start=1):
        shard.mkdir()
        assert grade(a_class, "--no-isolation", "--output", shard, "--shard", f"{part}/{parts}") == 0
    names = [name for shard in shards for name in documents(shard)]
    assert sorted(names) == sorted(documents(whole))  # each is in one shard
    assert len(names) == len(LEARNERS) * len(FILES)
    capsys.readouterr()
    assert grade("--collect", *shards, "--output", collected, "--format", "csv") == 0
    assert documents(collected) == documents(whole)
    assert capsys.readouterr().out == report


OLD, NEW = "2026-11-20T08:00:00+00:00", "2026-11-21T08:00:00+00:00"
PASSED, FAILED, ERROR = made.passing(made.ADA), made.failing(made.ADA), made.not_started(made.ADA)


def at(result: Result, time: str) -> Result:
    return replace(result, graded_at=time)


@pytest.mark.parametrize(
    ("results", "best"),
    [
        ((at(FAILED, OLD), at(PASSED, NEW)), at(PASSED, NEW)),
        ((at(PASSED, OLD), at(FAILED, NEW)), at(FAILED, NEW)),
        ((at(FAILED, OLD), at(ERROR, NEW)), at(FAILED, OLD)),
        ((at(ERROR, OLD), at(FAILED, NEW)), at(FAILED, NEW)),
        ((at(ERROR, OLD), at(ERROR, NEW)), at(ERROR, NEW)),
    ],
    ids=["newer", "newer-although-worse", "verdict-before-error", "verdict-after-error", "newer-error"],
)
@pytest.mark.parametrize("turned", [False, True], ids=["in-order", "the-other-way-round"])
@pytest.mark.parametrize("into_one", [False, True], ids=["into-a-new-folder", "into-one-of-them"])
def test_the_newest_verdict_wins(
    tmp_path: Path, results: tuple[Result, Result], best: Result, turned: bool, into_one: bool
) -> None:
    folders = [tmp_path / "a", tmp_path / "b"]
    for folder, result in zip(folders, results, strict=True):
        ResultFolder(folder).save(result)
    target = folders[0] if into_one else tmp_path / "all"
    code = grade("--collect", *(reversed(folders) if turned else folders), "--output", target)
    assert code == (3 if best.status == "error" else 0)
    assert [encode(result) for result in ResultFolder(target)] == [encode(best)]


def test_results_of_different_learners_and_exercises_are_all_kept(tmp_path: Path) -> None:
    results = made.whole_class()
    for number, result in enumerate(results):
        ResultFolder(tmp_path / str(number % 3)).save(result)
    assert grade("--collect", *(tmp_path / str(number) for number in range(3)), "--output", tmp_path / "all") == 3
    assert sorted(map(encode, ResultFolder(tmp_path / "all"))) == sorted(map(encode, results))


@pytest.mark.parametrize("shard", ["0/3", "4/3", "3", "/3", "1/0", "-1/3", "1/3/3", "a/b", ""])
def test_a_shard_that_does_not_exist(a_class: Path, tmp_path: Path, shard: str) -> None:
    assert grade(a_class, "--no-isolation", "--output", tmp_path / "results", "--shard", shard) == 2
    assert not (tmp_path / "results").exists()


def test_nothing_to_collect(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert grade("--collect", tmp_path / "absent", "--output", tmp_path / "all") == 2
    assert "there is no such folder" in capsys.readouterr().err
    (tmp_path / "empty").mkdir()
    assert grade("--collect", tmp_path / "empty", "--output", tmp_path / "all") == 2
    assert "there are no results in" in capsys.readouterr().err
