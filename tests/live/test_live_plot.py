from __future__ import annotations

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tutor.tui.live.plot import draw, limits, short


def dots(rows: tuple[tuple[str, str], ...]) -> list[str]:
    return [text for _, text in rows]


def test_rising_values_go_from_the_lower_left_to_the_upper_right() -> None:
    plot = draw([(n / 10, n / 10) for n in range(101)], 40, 11, 10.0, 10.0)
    rows = dots(plot.rows)
    assert rows[0].rstrip()
    assert not rows[0][:20].strip()
    assert rows[-1][0] != " "
    assert plot.rows[0][0].strip() == "10┤"
    assert plot.rows[-1][0].strip() == "0┤"
    assert plot.below.split() == ["10", "s", "ago", "now"]


def test_values_older_than_the_span_are_not_drawn() -> None:
    plot = draw([(0.0, 1000.0), (95.0, 1.0), (100.0, 2.0)], 40, 8, 100.0, 10.0)
    assert plot.rows[0][0].strip() == "2┤"


def test_a_long_silence_leaves_a_gap() -> None:
    points = [(n / 10, 1.0) for n in range(20)] + [(8 + n / 10, 1.0) for n in range(20)]
    line = next(text for text in dots(draw(points, 45, 8, 10.0, 10.0).rows) if text.strip())
    assert "          " in line.strip()


def test_a_slow_topic_is_still_one_line() -> None:
    line = next(
        text for text in dots(draw([(float(n), 1.0) for n in range(11)], 45, 8, 10.0, 10.0).rows) if text.strip()
    )
    assert " " not in line.strip()


def test_the_axis_is_stable_under_small_variations() -> None:
    assert limits([20.1, 29.7]) == limits([20.4, 29.2]) == (20.0, 30.0)
    low, high = limits([0.5])
    assert low < 0.5 < high


@pytest.mark.parametrize(
    ("value", "span", "text"), [(25.0, 10.0, "25"), (0.55, 0.1, "0.55"), (-0.0, 1.0, "0"), (1.8e9, 1e9, "1.80e+09")]
)
def test_labels_have_as_many_digits_as_needed(value: float, span: float, text: str) -> None:
    assert short(value, span) == text


def test_few_samples_are_marked_and_many_are_a_line() -> None:
    few = draw([(float(n), 20.0 + n) for n in range(10)], 60, 8, 10.0, 10.0)
    assert "".join(dots(few.rows)).count("•") == "".join(few.kinds).count("m") == 10
    many = draw([(n / 20, 20.0 + n % 10) for n in range(200)], 60, 8, 10.0, 10.0)
    assert "•" not in "".join(dots(many.rows))


def test_the_required_band_is_drawn_and_values_outside_stand_out() -> None:
    plot = draw([(2.0, 25.0), (6.0, 34.0)], 60, 12, 10.0, 10.0, band=(20.0, 30.0))
    edges = [axis.strip() for (axis, _), kinds in zip(plot.rows, plot.kinds, strict=True) if "b" in kinds]
    assert edges == ["30┤", "20┤"]
    assert "".join(plot.kinds).count("m") == 1
    assert "".join(plot.kinds).count("o") == 1
    assert any("╌╌╌" in text for text in dots(plot.rows))


@settings(deadline=None)  # a deadline would measure the machine's load
@given(
    st.lists(st.tuples(st.floats(0, 100), st.floats(-1e300, 1e300)), max_size=50),
    st.integers(12, 200),
    st.integers(3, 60),
)
@example([(40.0, 2.225073858507203e-309)], 12, 3)
def test_any_values_fit_the_size(points: list[tuple[float, float]], width: int, height: int) -> None:
    plot = draw(sorted(points), width, height, 100.0, 60.0)
    assert len(plot.rows) == height - 1
    lines = [axis + text for axis, text in plot.rows]
    assert all(len(line) <= max(width, len(axis) + 1) for line, (axis, _) in zip(lines, plot.rows, strict=True))
