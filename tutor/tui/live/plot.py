"""A line of values over time, drawn with braille dots between labelled axes. Pure."""

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
"""The bits of the dots of one character: two columns of four, from below."""

_STROKES = [[[sum(dots[low : high + 1]) for high in range(4)] for low in range(4)] for dots in _DOTS]
"""The bits from a lowest to a highest dot of a column."""

_HOLE = 4.0
"""A silence of this many usual periods is left open."""

_MARK = "•"
_FEW = 1.5
"""Samples are marked where there is one for this many cells at most: else the line is all that can be seen of them."""

_BAND = "╌"

_LEAST = 1e-290
"""A value nearer to 0 than this is drawn as 0: an axis around it could not be calculated with."""


@dataclass(frozen=True, slots=True)
class Plot:
    """A drawing: for each row the label of the y axis (all of one width) and the cells; and the label of the x axis.

    `kinds` has, for each row, a letter for each cell: `m` a sample, `o` one outside of the band, `b` an edge of it,
    and a blank for the line.
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
    """Draw the points of the `span_s` seconds before `now` into this many cells, labels included; `end` names `now`.

    `band`: the lowest and the highest value that are asked for; it is drawn, too.
    """
    first, end_of = (
        bisect.bisect_left(points, t, key=lambda point: point[0]) for t in (now - span_s, math.nextafter(now, math.inf))
    )
    times = [t for t, _ in itertools.islice(points, first, end_of)]
    values = [value for _, value in itertools.islice(points, first, end_of)]
    low, high, step = _scale([*values, *(band or ())])
    labels = _labels(low, high, step, max(1, height - 1))
    margin = max(len(label) for label in labels)
    cells = max(1, width - margin - 1)
    grid = _Grid(cells, max(1, height - 1), (now - span_s, span_s), (low, high - low))
    _line(grid, times, values)
    edge = [f"{label:>{margin}}" + ("┤" if label else "│") for label in labels]
    if band is not None:
        grid.rule(band)
    if len(times) * _FEW <= cells:
        grid.mark(times, values, band)
    drawn = grid.rows()
    rows = tuple((edge, "".join(cell for cell, _ in row)) for edge, row in zip(edge, drawn, strict=True))
    kinds = tuple("".join(kind for _, kind in row) for row in drawn)
    return Plot(rows, _below(margin, cells, span_s, end), kinds)


def _line(grid: _Grid, times: Sequence[float], values: Sequence[float]) -> None:
    """Draw the points, a column at a time: many cost little more than few."""
    before, place, usual = (0, 0), 0, 0.0
    while place < len(times):
        x, y = grid.column(times[place]), grid.row(values[place])
        if apart := place > 0 and x - before[0] > 2:
            usual = usual or _usual(times)
        hole = apart and times[place] - times[place - 1] > _HOLE * usual
        grid.join((x, y) if place == 0 or hole else before, (x, y))
        following = bisect.bisect_left(times, grid.end_of(x), place + 1)
        column = values[place:following]
        grid.stroke(x, grid.row(min(column)), grid.row(max(column)))
        before, place = (x, grid.row(column[-1])), following


def _usual(times: Sequence[float]) -> float:
    """The usual time between two of them."""
    return statistics.median(b - a for a, b in itertools.pairwise(times))


def limits(values: Sequence[float]) -> tuple[float, float]:
    """Round numbers around all values, so that the axis holds still while they vary a little."""
    low, high, _ = _scale(values)
    return low, high


def _scale(values: Sequence[float]) -> tuple[float, float, float]:
    """The axis: its ends, and the step between its labels."""
    if not values:
        return 0.0, 1.0, 0.5
    low, high = min(values), max(values)
    if high - low < 1e-9 * max(1.0, abs(high)):
        around = abs(high) * 0.1 if abs(high) > _LEAST else 1.0
        low, high = low - around, high + around
    step = _round_step((high - low) / 4)
    return math.floor(low / step + 1e-9) * step, math.ceil(high / step - 1e-9) * step, step


def _round_step(least: float) -> float:
    power = 10.0 ** math.floor(math.log10(least))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= least * 0.999)


def _labels(low: float, high: float, step: float, rows: int) -> list[str]:
    """Labels for as many of the steps as have room, the ends first; between them nothing."""
    labels = [""] * rows
    steps = round((high - low) / step)
    for number in (0, steps, *range(1, steps)):
        row = round((1 - number / steps) * (rows - 1))
        if not any(labels[max(0, row - 1) : row + 2]):
            labels[row] = short(low + number * step, high - low)
    return labels


def short(value: float, span: float) -> str:
    """A number with as many digits as tell it from its neighbours on an axis of this span."""
    if value and not 1e-4 <= max(abs(value), span) < 1e6:
        return f"{value:.2e}"
    digits = max(0, min(6, 2 - math.floor(math.log10(span)))) if span > 0 else 3
    text = f"{value:.{digits}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text in ("-0", "") else text


def _below(margin: int, cells: int, span_s: float, right: str) -> str:
    left = f"{span_s:g} s {'ago' if right == 'now' else 'before'}"
    gap = cells - len(left) - len(right)
    return " " * (margin + 1) + (left + " " * gap + right if gap > 0 else right.rjust(cells))


class _Grid:
    """Dots, four rows and two columns of them to a cell; y goes up. Each column is one stroke.

    `across` and `up` are what its width and its height stand for: where they begin, and how long they are.
    """

    def __init__(self, cells: int, rows: int, across: tuple[float, float], up: tuple[float, float]) -> None:
        self.width, self.height = cells * 2, rows * 4
        self._begin, self._low_value = across[0], up[0]
        self._across, self._up = self.width / across[1], (self.height - 1) / up[1]
        self._low = [self.height] * self.width
        self._high = [-1] * self.width
        self._rules: set[int] = set()
        self._marks: dict[tuple[int, int], str] = {}

    def column(self, t: float) -> int:
        """Where this time is."""
        return min(self.width - 1, int((t - self._begin) * self._across))

    def end_of(self, column: int) -> float:
        """The first time that is right of a column."""
        return self._begin + (column + 1) / self._across

    def row(self, value: float) -> int:
        """Where this value is."""
        return int((value - self._low_value) * self._up + 0.5)

    def join(self, start: tuple[int, int], end: tuple[int, int]) -> None:
        """Draw a line; `end` is not to the left of `start`."""
        (x0, y0), (x1, y1) = start, end
        if x1 - x0 <= 1:
            self.stroke(x1, y0, y1)
            return
        before = y0
        for x in range(x0 + 1, x1 + 1):
            y = round(y0 + (y1 - y0) * (x - x0) / (x1 - x0))
            self.stroke(x, before + (y > before) - (y < before), y)
            before = y

    def rule(self, values: Sequence[float]) -> None:
        """Draw a line across at each of these values, behind all else."""
        self._rules.update(self._cell_row(value) for value in values)

    def mark(self, times: Sequence[float], values: Sequence[float], band: tuple[float, float] | None) -> None:
        """Mark each point by itself, those outside of the band in their own way."""
        for t, value in zip(times, values, strict=True):
            outside = band is not None and not band[0] <= value <= band[1]
            self._marks[self._cell_row(value), self.column(t) // 2] = "o" if outside else "m"

    def _cell_row(self, value: float) -> int:
        """The row of characters of a value, from the top."""
        return self.height // 4 - 1 - self.row(value) // 4

    def rows(self) -> list[list[tuple[str, str]]]:
        """The characters with their kinds (see `Plot`), the top row first."""
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
        """Draw a column from the one dot to the other."""
        low, high = (y0, y1) if y0 < y1 else (y1, y0)
        if low < self._low[x]:
            self._low[x] = low
        if high > self._high[x]:
            self._high[x] = high
