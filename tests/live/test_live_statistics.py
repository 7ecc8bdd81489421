from __future__ import annotations

import itertools
import math
import random
import statistics

import pytest

from tutor.live.statistics import MIN_PERIODS, WINDOW_S, TopicStatistics


def make_statistics(stamps: list[float], numbers: list[int | None] | None = None) -> TopicStatistics:
    found = TopicStatistics()
    found.add(stamps, numbers or [None] * len(stamps))
    return found


def test_there_is_no_timing_for_fewer_than_two_messages() -> None:
    assert TopicStatistics().timing() is None
    assert make_statistics([5.0]).timing() is None
    assert make_statistics([5.0]).count == 1


def test_rate_and_jitter_are_computed_from_the_periods() -> None:
    random.seed(3)
    stamps = list(itertools.accumulate([100.0] + [0.1 + random.uniform(-0.02, 0.02) for _ in range(40)]))
    timing = make_statistics(stamps).timing()
    periods = [b - a for a, b in itertools.pairwise(stamps)]
    assert timing is not None
    assert timing.periods == 40
    assert timing.mean_s == pytest.approx(statistics.mean(periods))
    assert timing.rate_hz == pytest.approx(1 / statistics.mean(periods))
    assert timing.deviation_s == pytest.approx(statistics.pstdev(periods), rel=1e-6)
    assert timing.shortest_s == pytest.approx(min(periods))
    assert timing.longest_s == pytest.approx(max(periods))


def test_the_rate_covers_the_last_seconds_and_the_count_all_messages() -> None:
    slow = [n * 0.1 for n in range(100)]
    fast = [10.0 + n * 0.01 for n in range(1000)]
    found = make_statistics(slow)
    found.add(fast, [None] * 1000)
    timing = found.timing()
    assert timing is not None
    assert timing.rate_hz == pytest.approx(100, rel=0.01)
    assert found.count == 1100


def test_a_slow_topic_is_measured_over_more_than_the_window() -> None:
    timing = make_statistics([n * 2.0 for n in range(30)]).timing()
    assert timing is not None
    assert timing.periods >= MIN_PERIODS
    assert timing.mean_s == pytest.approx(2.0)


def test_a_long_pause_restarts_the_measurement() -> None:
    timing = make_statistics([*(n * 0.1 for n in range(20)), *(60 + n * 0.1 for n in range(5))]).timing()
    assert timing is not None
    assert timing.periods == 4
    assert timing.longest_s < WINDOW_S


def test_messages_of_several_publishers_may_be_out_of_order() -> None:
    stamps = [n * 0.1 for n in range(20)]
    stamps[3], stamps[4] = stamps[4], stamps[3]
    timing = make_statistics(stamps).timing()
    assert timing is not None
    assert timing.shortest_s >= 0
    assert timing.mean_s == pytest.approx(0.1)


def test_skipped_sequence_numbers_count_as_lost_but_a_restart_does_not() -> None:
    assert make_statistics([0.0] * 4, [7, 8, 11, 12]).missing == 2
    assert make_statistics([0.0] * 4, [7, 8, 1, 2]).missing == 0
    assert make_statistics([0.0] * 3, [None, None, None]).missing == 0


def test_a_flood_at_one_instant_has_no_rate() -> None:
    timing = make_statistics([1.0] * 10).timing()
    assert timing is not None
    assert timing.rate_hz == 0.0
    assert not math.isnan(timing.deviation_s)
