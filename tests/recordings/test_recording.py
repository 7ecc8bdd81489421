"""A recording holds what judges got, so that they can be asked again without ROS."""

from __future__ import annotations

from pathlib import Path

from tests.recordings.keep import keep
from tests.recordings.recording import (
    JudgeCall,
    Outcome,
    Recording,
    accept,
    from_document,
    read,
    read_documents,
    to_document,
    write,
)
from tests.recordings.rename import renamed
from tutor.judge.trace import LogRecord, Trace

TRACE = Trace("node.py", logs=(LogRecord(20, "node", "hello", 1.0, 1.5),))
MADE = Recording(
    "i2.1/wrong/made",
    (
        JudgeCall("rate", "", (TRACE, None)),
        JudgeCall("launch-validation", "", (TRACE, (Trace("node.py"), Trace("node.py")))),
        JudgeCall("atomic", "a_scenario", ((),)),
    ),
    {"rate": Outcome("failed", "wrong-rate", "why", "step")},
)


def test_facts_of_every_kind_are_read_back(tmp_path: Path) -> None:
    write(MADE, tmp_path)
    assert list(read(tmp_path)) == [MADE]


def test_facts_that_calls_share_are_one_object_again(tmp_path: Path) -> None:
    write(Recording("i2.1/right/made", (JudgeCall("a", "", (TRACE,)), JudgeCall("b", "", (TRACE,)))), tmp_path)
    first, second = next(read(tmp_path)).calls
    assert first.facts[0] is second.facts[0]


def test_recordings_are_kept_by_exercise_and_a_new_one_replaces_the_old_one(tmp_path: Path) -> None:
    ran, kept = tmp_path / "ran", tmp_path / "kept"
    cases = ["i1.1/right/a", "i1.1/wrong/b", "i1.2/right/c"]
    for case in (*cases, "i1.2/right/gone"):
        write(Recording(case, ()), ran)
    assert keep(ran, kept, frozenset(cases)) == {"i1.1": 2, "i1.2": 1}
    again = tmp_path / "again"
    changed = Recording("i1.1/wrong/b", (), {"rate": Outcome("failed")})
    write(changed, again)
    assert keep(again, kept, frozenset(cases)) == {"i1.1": 2, "i1.2": 1}
    assert list(read(kept, ["i1.1/wrong"])) == [changed]
    assert [recording.case for recording in read(kept)] == cases
    accept(kept, {"i1.1/right/a": {"rate": Outcome("passed")}})
    assert [recording.outcomes for recording in read(kept, ["i1.1/"])] == [
        {"rate": Outcome("passed")},
        changed.outcomes,
    ]


def test_a_class_or_a_field_that_has_another_name_now_is_found(tmp_path: Path) -> None:
    (document,) = read_documents(write(MADE, tmp_path))
    name = f"{Trace.__module__}:Trace"
    old = renamed(renamed(document, name, "tutor.judge.gone:Run"), "logs", "messages")
    assert {kind for kind, _ in old["facts"]} >= {"tutor.judge.gone:Run", "(tutor.judge.gone:Run)"}
    assert from_document(renamed(renamed(old, "tutor.judge.gone:Run", name), "messages", "logs")) == MADE
    assert to_document(MADE).keys() == old.keys()
