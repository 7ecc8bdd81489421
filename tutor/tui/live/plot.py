"""A line plot of values over time, drawn in braille dots with labelled axes. Pure."""

from __future__ import annotations

import bisect
import itertools
import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

Point = tuple[float, float]
"""Time in seconds, and a value."""

_BRAILLE = 0x2800
_DOTS = ((0x40, 0x04, 0x02, 0x01), (0x80, 0x20, 0x10, 0x08))
"""The bits of one braille character's dots: two columns of four, from the bottom."""

_STROKES = [[[sum(dots[low : high + 1]) for high in range(4)] for low in range(4)] for dots in _DOTS]
"""`_STROKES[column][low][high]`: the bits of a column's dots from `low` to `high`."""

_GAP_PERIODS = 4.0
"""A silence longer than this many usual periods is left as a gap in the line."""

_MARK = "•"
_MARK_MIN_CELLS = 1.5
"""Samples are marked if each has at least this many cells; if denser, the line alone shows them."""

_BAND = "╌"

_MIN_MAGNITUDE = 1e-290
"""A value closer to 0 than this is drawn as 0: an axis around it could not be computed."""


@dataclass(frozen=True, slots=True)
class Plot:
    """A drawing: `rows` pairs each row's y axis label (all of one width) with its cells; `below` is the x axis.

    `kinds` has one letter per cell of each row: `m` a sample, `o` one outside of the band, `b` an edge of the band, and
    a blank for anything else.
    """

    rows: tuple[tuple[str, str], ...]
    below: str
    kinds: tuple[str, ...]


def draw(
    points: Sequence[Point],
    width: int,
    height: int,
    now: float,
    span_s: float,
    end: str = "now",
    band: tuple[float, float] | None = None,
) -> Plot:
    """Draw the points of the `span_s` seconds before `now` into this many cells, labels included.

    `end` is the label of `now`. `band`: the lowest and highest value that the exercise asks for, drawn as two lines.
    """
    first, end_index = (
        bisect.bisect_left(points, t, key=lambda point: point[0]) for t in (now - span_s, math.nextafter(now, math.inf))
    )
    times = [t for t, _ in itertools.islice(points, first, end_index)]
    values = [value for _, value in itertools.islice(points, first, end_index)]
    low, high, step = _axis_scale([*values, *(band or ())])
    labels = _axis_labels(low, high, step, max(1, height - 1))
    margin = max(len(label) for label in labels)
    cells = max(1, width - margin - 1)
    grid = _Grid(cells, max(1, height - 1), (now - span_s, span_s), (low, high - low))
    _draw_line(grid, times, values)
    edges = [f"{label:>{margin}}" + ("┤" if label else "│") for label in labels]
    if band is not None:
        grid.rule(band)
    if len(times) * _MARK_MIN_CELLS <= cells:
        grid.mark(times, values, band)
    drawn = grid.rows()
    rows = tuple((edge, "".join(cell for cell, _ in row)) for edge, row in zip(edges, drawn, strict=True))
    kinds = tuple("".join(kind for _, kind in row) for row in drawn)
    return Plot(rows, _time_axis(margin, cells, span_s, end), kinds)


def _draw_line(grid: _Grid, times: Sequence[float], values: Sequence[float]) -> None:
    """Draw the points column by column, so that many cost little more than few."""
    previous, index, median_period = (0, 0), 0, 0.0
    while index < len(times):
        x, y = grid.column(times[index]), grid.row(values[index])
        if is_apart := index > 0 and x - previous[0] > 2:
            median_period = median_period or _median_period(times)
        is_gap = is_apart and times[index] - times[index - 1] > _GAP_PERIODS * median_period
        grid.join((x, y) if index == 0 or is_gap else previous, (x, y))
        next_index = bisect.bisect_left(times, grid.end_time(x), index + 1)
        column = values[index:next_index]
        grid.stroke(x, grid.row(min(column)), grid.row(max(column)))
        previous, index = (x, grid.row(column[-1])), next_index


def _median_period(times: Sequence[float]) -> float:
    """Return the median time between two samples."""
    return statistics.median(b - a for a, b in itertools.pairwise(times))


def limits(values: Sequence[float]) -> tuple[float, float]:
    """Return round limits around all values, so that the axis stays put while they vary a little."""
    low, high, _ = _axis_scale(values)
    return low, high


def _axis_scale(values: Sequence[float]) -> tuple[float, float, float]:
    """Return the ends of the y axis, and the step between its labels."""
    if not values:
        return 0.0, 1.0, 0.5
    low, high = min(values), max(values)
    if high - low < 1e-9 * max(1.0, abs(high)):
        margin = abs(high) * 0.1 if abs(high) > _MIN_MAGNITUDE else 1.0
        low, high = low - margin, high + margin
    step = _round_step((high - low) / 4)
    return math.floor(low / step + 1e-9) * step, math.ceil(high / step - 1e-9) * step, step


def _round_step(minimum: float) -> float:
    power = 10.0 ** math.floor(math.log10(minimum))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= minimum * 0.999)


def _axis_labels(low: float, high: float, step: float, rows: int) -> list[str]:
    """Return one label per row, empty between steps; the ends first, then as many steps as there is room for."""
    labels = [""] * rows
    steps = round((high - low) / step)
    for number in (0, steps, *range(1, steps)):
        row = round((1 - number / steps) * (rows - 1))
        if not any(labels[max(0, row - 1) : row + 2]):
            labels[row] = short(low + number * step, high - low)
    return labels


def short(value: float, span: float) -> str:
    """Return a number with enough digits to distinguish it from its neighbours on an axis of this span."""
    if value and not 1e-4 <= max(abs(value), span) < 1e6:
        return f"{value:.2e}"
    digits = max(0, min(6, 2 - math.floor(math.log10(span)))) if span > 0 else 3
    text = f"{value:.{digits}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text in ("-0", "") else text


def _time_axis(margin: int, cells: int, span_s: float, right: str) -> str:
    left = f"{span_s:g} s {'ago' if right == 'now' else 'before'}"
    gap = cells - len(left) - len(right)
    return " " * (margin + 1) + (left + " " * gap + right if gap > 0 else right.rjust(cells))


class _Grid:
    """A grid of dots, 2 x 4 per cell, y pointing up. Each column of dots holds one stroke.

    `across` and `up` are the ranges of time and value that the grid covers, each as start and length.
    """

    def __init__(self, cells: int, rows: int, across: tuple[float, float], up: tuple[float, float]) -> None:
        self.width, self.height = cells * 2, rows * 4
        self._start, self._base_value = across[0], up[0]
        self._columns_per_s, self._rows_per_unit = self.width / across[1], (self.height - 1) / up[1]
        self._low = [self.height] * self.width
        self._high = [-1] * self.width
        self._rules: set[int] = set()
        self._marks: dict[tuple[int, int], str] = {}

    def column(self, t: float) -> int:
        """Return the column of a time."""
        return min(self.width - 1, int((t - self._start) * self._columns_per_s))

    def end_time(self, column: int) -> float:
        """Return the first time to the right of a column."""
        return self._start + (column + 1) / self._columns_per_s

    def row(self, value: float) -> int:
        """Return the row of a value."""
        return int((value - self._base_value) * self._rows_per_unit + 0.5)

    def join(self, start: tuple[int, int], end: tuple[int, int]) -> None:
        """Draw a line; `end` is not to the left of `start`."""
        (x0, y0), (x1, y1) = start, end
        if x1 - x0 <= 1:
            self.stroke(x1, y0, y1)
            return
        previous = y0
        for x in range(x0 + 1, x1 + 1):
            y = round(y0 + (y1 - y0) * (x - x0) / (x1 - x0))
            self.stroke(x, previous + (y > previous) - (y < previous), y)
            previous = y

    def rule(self, values: Sequence[float]) -> None:
        """Draw a horizontal line at each of these values, behind everything else."""
        self._rules.update(self._cell_row(value) for value in values)

    def mark(self, times: Sequence[float], values: Sequence[float], band: tuple[float, float] | None) -> None:
        """Mark each point, those outside of the band differently."""
        for t, value in zip(times, values, strict=True):
            outside = band is not None and not band[0] <= value <= band[1]
            self._marks[self._cell_row(value), self.column(t) // 2] = "o" if outside else "m"

    def _cell_row(self, value: float) -> int:
        """Return the row of cells of a value, from the top."""
        return self.height // 4 - 1 - self.row(value) // 4

    def rows(self) -> list[list[tuple[str, str]]]:
        """Return the cells with their kinds (see `Plot`), the top row first."""
        return [
            [self._cell(row, column, bits) for column, bits in enumerate(line)] for row, line in enumerate(self._bits())
        ]

    def _cell(self, row: int, column: int, bits: int) -> tuple[str, str]:
        if kind := self._marks.get((row, column)):
            return _MARK, kind
        if bits:
            return chr(_BRAILLE | bits), " "
        return (_BAND, "b") if row in self._rules else (" ", " ")

    def _bits(self) -> list[list[int]]:
        drawn = []
        for base in range(self.height - 4, -1, -4):
            bits = [0] * (self.width // 2)
            for x, (low, high) in enumerate(zip(self._low, self._high, strict=True)):
                if low < base + 4 and high >= base:
                    lowest, highest = max(low - base, 0), min(high - base, 3)
                    bits[x // 2] |= _STROKES[x % 2][lowest][highest]
            drawn.append(bits)
        return drawn

    def stroke(self, x: int, y0: int, y1: int) -> None:
        """Extend a column's stroke to cover these two dots."""
        low, high = (y0, y1) if y0 < y1 else (y1, y0)
        if low < self._low[x]:
            self._low[x] = low
        if high > self._high[x]:
            self._high[x] = high
