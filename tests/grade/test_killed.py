"""`grade` killed in the middle and started again: the whole result, and nothing left over."""

from __future__ import annotations

import json
import shutil
import time
from pathlib import Path

import pytest

from tests.grade.grade_process import GradeProcess
from tutor.grade.results import ResultFolder

ROOT = Path(__file__).parents[2]
LIMIT_S = 200.0


@pytest.mark.timeout(2 * LIMIT_S)
def test_a_killed_run_is_finished_by_the_next_one(tmp_path: Path) -> None:
    submissions, results, temporary = tmp_path / "class", tmp_path / "results", tmp_path / "tmp"
    shutil.copytree(ROOT / "lessons" / "i2_2" / "solution", submissions / "ben")
    (submissions / "ada").mkdir()
    (submissions / "ada" / "my_launch.py").write_text("import nothing_of_the_kind\n")
    (results / "ada").mkdir(parents=True)
    (results / "ada" / ".i2.2.json.1.tmp").write_text("of a run that was killed before")
    words: list[str | Path] = [
        submissions,
        "--output",
        results,
        "--exercise",
        "i2.2",
        "--format",
        "json",
        "--jobs",
        "1",
    ]
    first = GradeProcess(words, temporary)
    try:
        deadline = time.monotonic() + LIMIT_S
        while not list(results.rglob("*.json")) or not first.left_running():  # while the second check runs
            assert first.process.poll() is None, first.err.read_text()
            assert time.monotonic() < deadline
            time.sleep(0.05)
        first.kill()  # and nothing is running any more
    finally:
        first.process.kill()
    kept = {path: path.read_text() for path in results.rglob("*.json")}
    assert [path.parent.name for path in kept] == ["ada"]
    second = GradeProcess(words, temporary)
    try:
        assert second.wait(LIMIT_S) == 0, second.err.read_text()
    finally:
        second.process.kill()
    assert {path: path.read_text() for path in kept} == kept
    found = {result.learner.id: result.status for result in ResultFolder(results)}
    assert found == {"ada": "failed", "ben": "passed"}
    assert json.loads(second.out.read_text())
    assert sorted(path.name for path in results.rglob("*")) == ["ada", "ben", "i2.2.json", "i2.2.json"]
    assert second.left_running() == []
    assert second.left_files() == []
