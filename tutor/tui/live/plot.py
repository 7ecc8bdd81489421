"""A line of values over time, drawn with braille dots between labelled axes. Pure."""

from __future__ import annotations

import itertools
import math
import statistics
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

Point = tuple[float, float]
"""Time in seconds, and a value."""

_BRAILLE = 0x2800
_DOTS = ((0x01, 0x02, 0x04, 0x40), (0x08, 0x10, 0x20, 0x80))
"""The bits of the dots of one character: two columns of four."""

_HOLE = 4.0
"""A silence of so many usual periods is left open."""


@dataclass(frozen=True, slots=True)
class Plot:
    """A drawing: for each row the label of the y axis (all of one width) and the dots; and the label of the x axis."""

    rows: tuple[tuple[str, str], ...]
    below: str


def draw(points: Sequence[Point], width: int, height: int, now: float, span_s: float, end: str = "now") -> Plot:
    """Draw the points of the `span_s` seconds before `now` into so many cells, labels included; `end` names `now`."""
    seen = [point for point in points if now - span_s <= point[0] <= now]
    low, high, step = _scale(value for _, value in seen)
    labels = _labels(low, high, step, max(1, height - 1))
    margin = max(len(label) for label in labels)
    cells = max(1, width - margin - 1)
    grid = _Grid(cells, max(1, height - 1))
    usual = statistics.median([b[0] - a[0] for a, b in itertools.pairwise(seen)]) if len(seen) > 1 else 0.0
    before: tuple[int, int] | None = None
    last_t = 0.0
    for t, value in seen:
        x = min(grid.width - 1, int((t - (now - span_s)) / span_s * grid.width))
        y = round((value - low) / (high - low) * (grid.height - 1))
        hole = before is not None and t - last_t > _HOLE * usual and x - before[0] > 2
        grid.line((x, y) if before is None or hole else before, (x, y))
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
        around = abs(high) * 0.1 or 1.0
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
    """Dots, four rows and two columns of them to a cell; y goes up."""

    def __init__(self, cells: int, rows: int) -> None:
        self.width, self.height = cells * 2, rows * 4
        self._bits = [[0] * cells for _ in range(rows)]

    def line(self, start: tuple[int, int], end: tuple[int, int]) -> None:
        (x0, y0), (x1, y1) = start, end
        steps = max(abs(x1 - x0), abs(y1 - y0), 1)
        for step in range(steps + 1):
            self._dot(round(x0 + (x1 - x0) * step / steps), round(y0 + (y1 - y0) * step / steps))

    def rows(self) -> list[str]:
        return ["".join(chr(_BRAILLE | bits) if bits else " " for bits in row) for row in self._bits]

    def _dot(self, x: int, y: int) -> None:
        down = self.height - 1 - y
        if 0 <= x < self.width and 0 <= down < self.height:
            self._bits[down // 4][x // 2] |= _DOTS[x % 2][down % 4]
