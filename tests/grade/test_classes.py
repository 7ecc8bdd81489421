"""The class that benchmarks grade is found as it was made."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from tests.grade.classes import EMPTY, KINDS, MISNAMED, make_class
from tutor.content import load_course
from tutor.grade.roster import Roster
from tutor.grade.work import find_work


def test_every_submission_is_found_and_complete(tmp_path: Path) -> None:
    made = make_class(tmp_path / "made", learners=30)
    (tmp_path / "scratch").mkdir()
    notes: list[str] = []
    works = find_work(
        made.folder, load_course(), tmp_path / "scratch", roster=Roster.read(made.roster), note=notes.append
    )
    assert notes == []
    assert {(work.learner.id, work.exercise) for work in works} == set(made.expected)
    assert len(works) == 31 * 2
    for work in works:
        expectation = made.expected[work.learner.id, work.exercise]
        assert bool(work.missing) is (expectation.kind in (EMPTY, MISNAMED)), work
        assert work.learner.name == f"Zoë {work.learner.id}"
        if expectation.case is not None:
            names = {file.name for file in load_course().find(work.exercise).files if file.required}
            for name in names:
                at = name if work.main == "." else f"{work.main}/{name}"
                assert work.files[at].read_bytes() == (expectation.case.folder / name).read_bytes()
    kinds = Counter(expectation.kind for expectation in made.expected.values())
    assert set(kinds) == set(KINDS)


def test_the_same_seed_makes_the_same_class(tmp_path: Path) -> None:
    first, same, other = (make_class(tmp_path / name, 6, seed=seed) for name, seed in (("a", 3), ("b", 3), ("c", 4)))
    assert first.expected == same.expected
    assert first.expected != other.expected
