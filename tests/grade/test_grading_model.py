"""The model of the queue agrees with what can be worked out by hand."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.benchmarks.grading_model import Job, class_s, simulate


@pytest.mark.parametrize(
    ("jobs", "cores", "slots", "seconds"),
    [
        ([], 2, 4, 0),
        ([Job(1, 10)], 2, 4, 10),
        ([Job(10, 10)] * 4, 2, 4, 20),  # CPU
        ([Job(10, 10)] * 4, 2, 2, 20),
        ([Job(0, 10)] * 5, 2, 2, 30),  # waiting
        ([Job(0, 10)] * 5, 2, 5, 10),
        ([Job(20, 10), Job(0, 10)], 1, 2, 20),
        ([Job(20, 10), Job(5, 10)], 2, 2, 10 + 5 / 2),  # 1.5 cores for 10 s, then 2
        ([Job(0, 1), Job(0, 9), Job(0, 9)], 2, 2, 10),
    ],
)
def test_by_hand(jobs: list[Job], cores: float, slots: int, seconds: float) -> None:
    assert simulate(jobs, cores, slots) == pytest.approx(seconds)


@settings(max_examples=50)
@given(
    st.lists(st.builds(Job, st.floats(0.1, 30), st.floats(0.1, 30)), min_size=1, max_size=12),
    st.sampled_from([1, 2, 8]),
    st.integers(1, 6),
)
def test_no_schedule_beats_the_bounds(jobs: list[Job], cores: float, slots: int) -> None:
    took = simulate(jobs, cores, slots)
    alone = [max(job.wall_s, job.cpu_s / cores) for job in jobs]
    assert took >= max(sum(job.cpu_s for job in jobs) / cores, sum(job.wall_s for job in jobs) / slots, *alone) - 1e-6
    assert took <= sum(alone) + 1e-6


def test_more_machines_take_less_time() -> None:
    exercises = ("i1.1", "i2.2")
    assert class_s(30, exercises, 2, 1, 0.0) > class_s(30, exercises, 8, 1, 0.0) > class_s(30, exercises, 8, 4, 0.0)
    assert class_s(300, exercises, 8, 1, 0.0) == pytest.approx(10 * class_s(30, exercises, 8, 1, 0.0), rel=0.2)
