"""Progress is bounded, survives kills and concurrent writers, and is never silently lost."""

from __future__ import annotations

import json
import multiprocessing
import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.workspace.conftest import make_lesson
from tutor.errors import StorageError
from tutor.judge.result import CriterionResult, ExerciseResult
from tutor.judge.verdict import Status, Verdict
from tutor.workspace import (
    Attempt,
    ExerciseProgress,
    Help,
    Progress,
    ProgressFile,
    Workspace,
    start,
    version_of,
    versions_of,
)
from tutor.workspace.progress import decode, encode


def result(status: Status, bonus: Status = Status.PASSED) -> ExerciseResult:
    criteria = (
        CriterionResult("publishes", "It publishes.", False, Verdict(status), 0.1),
        CriterionResult("shutdown", "It stops.", True, Verdict(bonus), 0.1),
    )
    return ExerciseResult("i1.1", "Lesson", ("a.py",), criteria, 0.2)


@pytest.fixture
def messages() -> list[str]:
    return []


@pytest.fixture
def file(workspace: Workspace, messages: list[str]) -> ProgressFile:
    return workspace.progress(messages.append)


def test_reading_without_a_file_is_empty_and_creates_nothing(file: ProgressFile) -> None:
    assert file.read() == Progress()
    assert not file.path.parent.exists()


def test_written_progress_is_read_back(file: ProgressFile) -> None:
    file.change(lambda p: p.with_start("i1.1").with_attempt(result(Status.FAILED), whole=True).with_tick("timers"))
    progress = file.read()
    attempt = progress.of("i1.1").last
    assert attempt is not None
    assert (attempt.verdict, attempt.passed, attempt.whole) == (Status.FAILED, ("shutdown",), True)
    assert progress.of("i1.1").best is Status.FAILED
    assert set(progress.ticks) == {"timers"}
    assert json.loads(file.path.read_text())["schema"] == "ros-tutor/progress/1"


def test_best_result_is_kept_and_set_only_by_whole_checks(file: ProgressFile) -> None:
    def attempt(status: Status, whole: bool) -> Status | None:
        return file.change(lambda p: p.with_attempt(result(status), whole=whole)).of("i1.1").best

    assert attempt(Status.PASSED, whole=False) is None
    assert attempt(Status.FAILED, whole=True) is Status.FAILED
    assert attempt(Status.PASSED, whole=True) is Status.PASSED
    assert attempt(Status.FAILED, whole=True) is Status.PASSED
    assert len(file.read().of("i1.1").attempts) == 4


def test_criteria_left_unjudged_after_a_failure_make_the_check_partial(file: ProgressFile) -> None:
    file.change(lambda p: p.with_attempt(result(Status.PASSED), whole=True))
    ended = replace(result(Status.FAILED, bonus=Status.SKIPPED), unjudged=("shutdown",))
    last = file.change(lambda p: p.with_attempt(ended, whole=True)).of("i1.1").last
    assert last is not None
    assert (last.whole, last.judged, last.passed) == (False, ("publishes",), ())


def test_a_tool_fault_is_not_an_attempt(file: ProgressFile) -> None:
    file.change(lambda p: p.with_attempt(result(Status.ERROR), whole=True))
    assert file.read().of("i1.1").attempts == ()


def test_attempts_are_bounded() -> None:
    progress = Progress()
    for _ in range(250):
        progress = progress.with_attempt(result(Status.FAILED), whole=True)
    assert len(progress.of("i1.1").attempts) == 200


def test_the_first_pass_stays_on_record() -> None:
    progress = Progress().with_attempt(result(Status.PASSED), whole=True).with_solution("i1.1")
    for _ in range(250):
        progress = progress.with_attempt(result(Status.FAILED), whole=True)
    kept = progress.of("i1.1")
    assert len(kept.attempts) == 200
    assert kept.first_pass is kept.attempts[0]
    assert kept.first_pass is not None
    assert (kept.first_pass.help, kept.help) == (Help.NONE, Help.SOLUTION)


def test_an_attempt_records_its_files_and_what_was_seen_before(file: ProgressFile) -> None:
    def attempt(change: Callable[[Progress], Progress] = lambda progress: progress) -> Attempt:
        last = file.change(lambda p: change(p).with_attempt(judged, whole=True)).of("i1.1").last
        assert last is not None
        return last

    judged = replace(result(Status.FAILED), digests={"a.py": "1", "b.py": ""}, given=("shutdown",))
    first = attempt()
    assert (first.version, first.given, first.help) == (version_of({"a.py": "1"}), ("shutdown",), Help.NONE)
    assert first.version != version_of({"a.py": "2"}) != ""
    assert version_of({"a.py": ""}) == version_of({}) == ""
    assert attempt(lambda p: p.with_criterion_hint("i1.1")).help is Help.HINTS
    assert attempt(lambda p: p.with_hints("i1.1", 2)).help is Help.HINTS
    assert attempt(lambda p: p.with_solution("i1.1")).help is Help.SOLUTION
    assert file.change(lambda p: p.with_solution("i1.1")) == file.read()


def test_a_criterion_that_could_not_be_judged_was_not_judged(file: ProgressFile) -> None:
    last = file.change(lambda p: p.with_attempt(result(Status.PASSED, Status.ERROR), whole=True)).of("i1.1").last
    assert last is not None
    assert last.is_pass
    assert last.judged_of(["publishes", "shutdown"]) == ["publishes"]


def test_versions_are_those_of_the_files_on_disk(workspace: Workspace, tmp_path: Path) -> None:
    lesson = make_lesson(tmp_path / "l", "i1.1", ["a.py", "b.py"], optional=("b.py",))
    assert versions_of([lesson], workspace) == {"i1.1": ""}
    start(lesson, workspace)
    whole = versions_of([lesson], workspace)["i1.1"]
    workspace.path_of("b.py").unlink()
    part = versions_of([lesson], workspace)["i1.1"]
    workspace.path_of("a.py").write_text("changed\n")
    assert len({"", whole, part, versions_of([lesson], workspace)["i1.1"]}) == 4


def test_hints_come_one_by_one_and_the_last_repeats(file: ProgressFile) -> None:
    shown = [file.next_hint("i1.1", total=3) for _ in range(5)]
    assert shown == [(1, False), (2, False), (3, False), (3, True), (3, True)]


def test_ticks_can_be_set_and_removed(file: ProgressFile) -> None:
    first = file.change(lambda p: p.with_tick("a").with_tick("b"))
    assert file.change(lambda p: p.with_tick("a")).ticks == first.ticks
    assert set(file.change(lambda p: p.with_tick("a", ticked=False)).ticks) == {"b"}
    assert set(file.change(lambda p: p.with_tick("never ticked", ticked=False)).ticks) == {"b"}


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"{",
        b"[]",
        b"null",
        b"\xff\xfe",
        b"[" * 100_000,
        b'{"schema": "ros-tutor/progress/1"}',
        b'{"schema": "something", "exercises": {}, "checklist": {}}',
        b'{"schema": "ros-tutor/progress/1", "exercises": {"i1.1": 7}, "checklist": {}}',
        b'{"schema": "ros-tutor/progress/1", "exercises": {}, "checklist": {"a": 1}}',
    ],
)
def test_a_damaged_file_is_set_aside_with_one_message(file: ProgressFile, messages: list[str], content: bytes) -> None:
    file.path.parent.mkdir(parents=True)
    file.path.write_bytes(content)

    assert file.read() == Progress()
    assert file.read() == Progress()

    aside = list(file.path.parent.glob("progress.json.damaged-*"))
    assert [path.read_bytes() for path in aside] == [content]
    assert len(messages) == 1
    assert "damaged" in messages[0]
    assert str(aside[0]) in messages[0]


def test_a_file_of_a_newer_version_is_set_aside_and_reported(file: ProgressFile, messages: list[str]) -> None:
    file.path.parent.mkdir(parents=True)
    file.path.write_text('{"schema": "ros-tutor/progress/2", "everything": "else"}')
    file.change(lambda p: p.with_tick("a"))
    assert set(file.read().ticks) == {"a"}
    assert len(list(file.path.parent.glob("progress.json.damaged-*"))) == 1
    assert len(messages) == 1
    assert "a newer ros-tutor wrote it" in messages[0]


def test_a_folder_in_place_of_the_file_is_a_clear_error(file: ProgressFile) -> None:
    file.path.mkdir(parents=True)
    with pytest.raises(StorageError, match=r"cannot read .*progress\.json: Is a directory"):
        file.read()


def tick_many(path: Path, name: str, times: int) -> None:
    file = ProgressFile(path)
    for number in range(times):
        file.change(lambda p, item=f"{name}-{number}": p.with_tick(item))  # type: ignore[misc]


def test_concurrent_processes_lose_no_updates(file: ProgressFile) -> None:
    fork = multiprocessing.get_context("fork")
    writers = [fork.Process(target=tick_many, args=(file.path, name, 100)) for name in ("a", "b")]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join(timeout=60)
    assert [writer.exitcode for writer in writers] == [0, 0]
    assert set(file.read().ticks) == {f"{name}-{number}" for name in ("a", "b") for number in range(100)}


WRITE_FOREVER = """
import sys
from pathlib import Path
from tutor.workspace import ProgressFile
file = ProgressFile(Path(sys.argv[1]))
number = 0
while True:
    file.change(lambda p: p.with_tick(f"{number}-" + "x" * 2000))
    print(number, flush=True)
    number += 1
"""


def test_a_kill_at_any_moment_leaves_a_valid_file(file: ProgressFile, messages: list[str]) -> None:
    for kill_after in (1, 7, 13):
        writer = subprocess.Popen(
            [sys.executable, "-c", WRITE_FOREVER, str(file.path)], stdout=subprocess.PIPE, text=True
        )
        assert writer.stdout is not None
        for line in writer.stdout:
            if int(line) >= kill_after:
                break
        writer.send_signal(signal.SIGKILL)
        written = [kill_after, *(int(line) for line in writer.stdout)][-1]
        writer.wait(timeout=10)
        writer.stdout.close()
        numbers = {int(item.split("-")[0]) for item in file.read().ticks}
        assert numbers >= set(range(written + 1))
    file.change(lambda p: p.with_tick("and on"))
    assert messages == []
    assert {path.name for path in file.path.parent.iterdir()} == {"progress.json", "progress.lock"}


@pytest.mark.usefixtures("permissions_enforced")
def test_an_unwritable_workspace_is_a_clear_error(file: ProgressFile) -> None:
    file.path.parent.parent.mkdir()
    file.path.parent.mkdir(mode=0o500)
    with pytest.raises(StorageError, match=r"cannot write to .*\.ros-tutor: Permission denied"):
        file.change(lambda p: p.with_tick("a"))


statuses = st.sampled_from([Status.PASSED, Status.FAILED])
ids = st.lists(st.text(), max_size=3).map(tuple)
attempts = st.builds(
    Attempt, st.text(), statuses, ids, st.booleans(), ids, ids, st.text(), ids, st.none() | st.sampled_from(Help)
)
progresses = st.builds(
    Progress,
    st.dictionaries(
        st.text(),
        st.builds(
            ExerciseProgress,
            st.none() | st.text(),
            st.lists(attempts, max_size=3).map(tuple),
            st.none() | statuses,
            st.integers(0, 3),
            st.booleans(),
            st.none() | st.text(),
        ),
        max_size=3,
    ),
    st.dictionaries(st.text(), st.text(), max_size=3),
)


@settings(max_examples=50)
@given(progresses)
def test_every_progress_round_trips(progress: Progress) -> None:
    assert decode(encode(progress)) == progress


@settings(max_examples=50)
@given(st.text() | st.recursive(st.none() | st.integers() | st.text(), st.lists).map(json.dumps))
def test_any_other_text_is_reported_as_damaged(text: str) -> None:
    with pytest.raises(ValueError, match="it is damaged"):
        decode(text)


EARLIER_FILE = """{
 "schema": "ros-tutor/progress/1",
 "exercises": {
  "i1.1": {
   "started_at": "2026-01-02T03:04:05Z",
   "attempts": [{"at": "2026-01-02T03:04:06Z", "verdict": "failed", "passed": ["node"], "whole": true}],
   "best": "failed",
   "hints": 2
  }
 },
 "checklist": {"topics": "2026-01-02T03:04:07Z"}
}"""


def test_a_file_of_an_earlier_version_is_read() -> None:
    progress = decode(EARLIER_FILE)
    attempt = Attempt("2026-01-02T03:04:06Z", Status.FAILED, ("node",))
    assert progress.of("i1.1") == ExerciseProgress("2026-01-02T03:04:05Z", (attempt,), Status.FAILED, 2)
    assert progress.ticks == {"topics": "2026-01-02T03:04:07Z"}
    assert decode(encode(progress)) == progress


@pytest.mark.parametrize(
    ("text", "replacement"),
    [('"hints": 2', '"hints": -1'), ('"whole": true', '"whole": 1'), ('"failed", "passed"', '"maybe", "passed"')],
)
def test_an_invalid_value_is_reported_as_damaged(text: str, replacement: str) -> None:
    assert text in EARLIER_FILE
    with pytest.raises(ValueError, match="damaged"):
        decode(EARLIER_FILE.replace(text, replacement))


def test_answers_to_predictions_are_kept_and_survive_the_disk() -> None:
    first = Progress().with_prediction("i2.3", "two-groups", False).with_prediction("i2.3", "reentrant", True)
    wrong, right = first.of("i2.3").predictions["two-groups"], first.of("i2.3").predictions["reentrant"]
    assert ((wrong.right, wrong.seen), (right.right, right.seen)) == ((False, False), (True, False))
    later = first.with_prediction("i2.3", "two-groups", True).with_prediction("i2.3", "reentrant", False)
    again = later.of("i2.3").predictions["two-groups"]
    assert (again.right, again.seen) == (True, True)
    assert later.of("i2.3").predictions["reentrant"] == right
    assert decode(encode(later)) == later


def test_checks_in_a_row_that_failed_by_a_mistake_are_counted_from_the_last() -> None:
    def attempt(*mistakes: str) -> Attempt:
        return Attempt("2026-01-02T03:04:06Z", Status.FAILED, (), mistakes=mistakes)

    attempts = (attempt("a"), attempt("b"), attempt("a", "b"), attempt("a"))
    progress = ExerciseProgress(attempts=attempts)
    assert [progress.in_a_row(mistake) for mistake in ("a", "b", "c")] == [2, 0, 0]
    assert ExerciseProgress().in_a_row("a") == 0
    assert ExerciseProgress(attempts=(Attempt("", Status.PASSED, ("rate",)),)).in_a_row("") == 0
