from __future__ import annotations

import itertools
import math
import random
import statistics

import pytest

from tutor.live.statistics import MIN_PERIODS, WINDOW_S, TopicStatistics


def fed(stamps: list[float], numbers: list[int | None] | None = None) -> TopicStatistics:
    found = TopicStatistics()
    found.add(stamps, numbers or [None] * len(stamps))
    return found


def test_nothing_has_no_timing_and_one_message_has_none_either() -> None:
    assert TopicStatistics().timing() is None
    assert fed([5.0]).timing() is None
    assert fed([5.0]).count == 1


def test_rate_and_jitter_are_those_of_the_periods() -> None:
    random.seed(3)
    stamps = list(itertools.accumulate([100.0] + [0.1 + random.uniform(-0.02, 0.02) for _ in range(40)]))
    timing = fed(stamps).timing()
    periods = [b - a for a, b in itertools.pairwise(stamps)]
    assert timing is not None
    assert timing.periods == 40
    assert timing.mean_s == pytest.approx(statistics.mean(periods))
    assert timing.rate_hz == pytest.approx(1 / statistics.mean(periods))
    assert timing.deviation_s == pytest.approx(statistics.pstdev(periods), rel=1e-6)
    assert timing.shortest_s == pytest.approx(min(periods))
    assert timing.longest_s == pytest.approx(max(periods))


def test_only_the_last_seconds_count_but_every_message_does() -> None:
    slow = [n * 0.1 for n in range(100)]
    fast = [10.0 + n * 0.01 for n in range(1000)]
    found = fed(slow)
    found.add(fast, [None] * 1000)
    timing = found.timing()
    assert timing is not None
    assert timing.rate_hz == pytest.approx(100, rel=0.01)
    assert found.count == 1100


def test_a_slow_topic_is_measured_over_more_than_the_window() -> None:
    timing = fed([n * 2.0 for n in range(30)]).timing()
    assert timing is not None
    assert timing.periods >= MIN_PERIODS
    assert timing.mean_s == pytest.approx(2.0)


def test_after_a_long_pause_measuring_begins_again() -> None:
    timing = fed([*(n * 0.1 for n in range(20)), *(60 + n * 0.1 for n in range(5))]).timing()
    assert timing is not None
    assert timing.periods == 4
    assert timing.longest_s < WINDOW_S


def test_several_publishers_messages_may_come_out_of_order() -> None:
    stamps = [n * 0.1 for n in range(20)]
    stamps[3], stamps[4] = stamps[4], stamps[3]
    timing = fed(stamps).timing()
    assert timing is not None
    assert timing.shortest_s >= 0
    assert timing.mean_s == pytest.approx(0.1)


def test_skipped_numbers_are_lost_messages_and_a_new_publisher_is_no_loss() -> None:
    assert fed([0.0] * 4, [7, 8, 11, 12]).missing == 2
    assert fed([0.0] * 4, [7, 8, 1, 2]).missing == 0
    assert fed([0.0] * 3, [None, None, None]).missing == 0


def test_a_flood_at_one_instant_has_no_rate() -> None:
    timing = fed([1.0] * 10).timing()
    assert timing is not None
    assert timing.rate_hz == 0.0
    assert not math.isnan(timing.deviation_s)
