"""A line of values over time, drawn with braille dots between labelled axes. Pure."""

from __future__ import annotations

import bisect
import itertools
import math
import statistics
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

Point = tuple[float, float]
"""Time in seconds, and a value."""

_BRAILLE = 0x2800
_DOTS = ((0x40, 0x04, 0x02, 0x01), (0x80, 0x20, 0x10, 0x08))
"""The bits of the dots of one character: two columns of four, from below."""

_STROKES = [[[sum(dots[low : high + 1]) for high in range(4)] for low in range(4)] for dots in _DOTS]
"""The bits from a lowest to a highest dot of a column."""

_HOLE = 4.0
"""A silence of so many usual periods is left open."""

_LEAST = 1e-290
"""A value nearer to 0 than this is drawn as 0: an axis around it could not be calculated with."""


@dataclass(frozen=True, slots=True)
class Plot:
    """A drawing: for each row the label of the y axis (all of one width) and the dots; and the label of the x axis."""

    rows: tuple[tuple[str, str], ...]
    below: str


def draw(points: Sequence[Point], width: int, height: int, now: float, span_s: float, end: str = "now") -> Plot:
    """Draw the points of the `span_s` seconds before `now` into so many cells, labels included; `end` names `now`."""
    first, end_of = (
        bisect.bisect_left(points, t, key=lambda point: point[0]) for t in (now - span_s, math.nextafter(now, math.inf))
    )
    seen = points[first:end_of]
    low, high, step = _scale(value for _, value in seen)
    labels = _labels(low, high, step, max(1, height - 1))
    margin = max(len(label) for label in labels)
    cells = max(1, width - margin - 1)
    grid = _Grid(cells, max(1, height - 1))
    usual = statistics.median([b[0] - a[0] for a, b in itertools.pairwise(seen)]) if len(seen) > 1 else 0.0
    across, up = grid.width / span_s, (grid.height - 1) / (high - low)
    begin, before, last_t = now - span_s, None, 0.0
    for t, value in seen:
        x, y = min(grid.width - 1, int((t - begin) * across)), int((value - low) * up + 0.5)
        hole = before is not None and t - last_t > _HOLE * usual and x - before[0] > 2
        grid.join((x, y) if before is None or hole else before, (x, y))
        before, last_t = (x, y), t
    edge = [f"{label:>{margin}}" + ("┤" if label else "│") for label in labels]
    return Plot(tuple(zip(edge, grid.rows(), strict=True)), _below(margin, cells, span_s, end))


def limits(values: Iterable[float]) -> tuple[float, float]:
    """Round numbers around all values, so that the axis holds still while they vary a little."""
    low, high, _ = _scale(values)
    return low, high


def _scale(values: Iterable[float]) -> tuple[float, float, float]:
    """The axis: its ends, and the step between its labels."""
    known = list(values)
    if not known:
        return 0.0, 1.0, 0.5
    low, high = min(known), max(known)
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
    """Dots, four rows and two columns of them to a cell; y goes up.

    Each column is one stroke from its lowest to its highest dot: a thousand points cost little more than the columns.
    """

    def __init__(self, cells: int, rows: int) -> None:
        self.width, self.height = cells * 2, rows * 4
        self._low = [self.height] * self.width
        self._high = [-1] * self.width

    def join(self, start: tuple[int, int], end: tuple[int, int]) -> None:
        """Draw a line; `end` is not to the left of `start`."""
        (x0, y0), (x1, y1) = start, end
        if x1 - x0 <= 1:
            self._stroke(x1, y0, y1)
            return
        before = y0
        for x in range(x0 + 1, x1 + 1):
            y = round(y0 + (y1 - y0) * (x - x0) / (x1 - x0))
            self._stroke(x, before + (y > before) - (y < before), y)
            before = y

    def rows(self) -> list[str]:
        """The characters, the top row first."""
        drawn = []
        for base in range(self.height - 4, -1, -4):
            bits = [0] * (self.width // 2)
            for x, (low, high) in enumerate(zip(self._low, self._high, strict=True)):
                if low < base + 4 and high >= base:
                    lowest, highest = max(low - base, 0), min(high - base, 3)
                    bits[x // 2] |= _STROKES[x % 2][lowest][highest]
            drawn.append("".join(chr(_BRAILLE | one) if one else " " for one in bits))
        return drawn

    def _stroke(self, x: int, y0: int, y1: int) -> None:
        low, high = (y0, y1) if y0 < y1 else (y1, y0)
        if low < self._low[x]:
            self._low[x] = low
        if high > self._high[x]:
            self._high[x] = high
