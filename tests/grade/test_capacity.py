"""How much a machine can do at once, and how long a class takes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tests.grade.made import ADA, BRIAN, CHLOE, failing, missing, passing, unjudged
from tutor.grade import capacity
from tutor.grade.capacity import (
    COSTS,
    DEFAULT_COST,
    Cost,
    checks_at_once,
    cores,
    costs_from,
    estimate_s,
    memory_mb,
    words_for,
)


@pytest.fixture
def cgroup(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(capacity, "_CGROUP", tmp_path)
    monkeypatch.setattr("os.sched_getaffinity", lambda pid: set(range(8)))
    return tmp_path


def test_cores(cgroup: Path) -> None:
    assert cores() == 8
    for quota, expected in (("max 100000", 8), ("150000 100000", 1.5), ("1000 100000", 0.5), ("9900000 100000", 8)):
        (cgroup / "cpu.max").write_text(f"{quota}\n")
        assert cores() == expected


def test_memory(cgroup: Path) -> None:
    free = memory_mb()
    assert free > 0
    (cgroup / "memory.max").write_text("max\n")
    (cgroup / "memory.current").write_text("0\n")
    (cgroup / "memory.stat").write_text("anon 5\ninactive_file 20971520\n")
    assert memory_mb() == pytest.approx(free, rel=0.2)
    (cgroup / "memory.max").write_text(f"{100 << 20}\n")
    (cgroup / "memory.current").write_text(f"{90 << 20}\n")
    assert memory_mb() == 30


def test_checks_at_once_keep_to_cores_and_memory(cgroup: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(capacity, "memory_mb", lambda: 1e6)
    assert checks_at_once() == 16
    (cgroup / "cpu.max").write_text("150000 100000\n")
    assert checks_at_once() == 3
    monkeypatch.setattr(capacity, "memory_mb", lambda: 2000.0)
    assert checks_at_once() == 2
    monkeypatch.setattr(capacity, "memory_mb", lambda: -5.0)
    assert checks_at_once() == 1


def test_the_estimate_is_what_the_machine_allows() -> None:
    costs = {"cpu": Cost(20, 5), "wait": Cost(1, 30)}
    assert estimate_s([], costs, 4, 2) == 0
    assert estimate_s(["cpu"] * 10, costs, 4, 2) == 100
    assert estimate_s(["wait"] * 10, costs, 4, 2) == 75
    assert estimate_s(["wait"], costs, 4, 2) == 30
    assert estimate_s(["unknown"], costs, 4, 2) == DEFAULT_COST.wall_s


def test_costs_are_those_measured_before() -> None:
    results = [replace(passing(learner), cpu_s=cpu) for learner, cpu in ((ADA, 1.0), (BRIAN, 5.0))]
    assert costs_from(results) == COSTS
    results += [replace(failing(CHLOE), cpu_s=3.0), replace(unjudged(ADA), cpu_s=99.0), missing(ADA, "i2.1")]
    costs = costs_from(results)
    assert costs["i1.1"] == Cost(3.0, min(COSTS["i1.1"].wall_s, passing(ADA).report.duration_s))
    assert costs["i2.1"] == COSTS["i2.1"]


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        *((0, "10 seconds"), (41, "50 seconds"), (90, "2 minutes"), (120, "2 minutes"), (1241, "21 minutes")),
        *((5399, "90 minutes"), (5400, "1.5 hours"), (36000, "10.0 hours")),
    ],
)
def test_durations_as_people_say_them(seconds: float, words: str) -> None:
    assert words_for(seconds) == words
