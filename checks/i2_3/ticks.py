"""I2.3: find the timer's log messages, and measure how fast it ticks.

A learner may log every tick or every tenth, with its number or without, in any words, and among any other messages. So
the timer's messages are recognised by their properties: alike, repeated while nobody calls, and ten ticks per second.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import median

from checks.i2_3.messages import Key, Tick, first_word, has_word, numbers, shape_of
from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import LogRecord

HZ = 10.0

EVEN_SHARE = 0.5
"""Messages of different wording form one series if most intervals deviate from the median by at most this share."""

CLOCKS_HZ = (1e3, 1e6, 1e9)
"""A number that rises at one of these rates is a time in ms, µs or ns, not a count of ticks."""

MIN_SPAN_S = 0.9
"""Minimum duration of a series: a shorter burst of messages belongs to the node's startup."""

MAX_MESSAGES = 2000
"""Of a flood of messages, only this many of the latest are analysed."""

RESTART_STEP = 2
"""A number that falls by more than this starts over; if by less, overlapping callbacks logged out of order."""

COVERED_SHARE = 0.8
"""A numbered series with at least this share of a function's messages is preferred to counting the messages."""


@dataclass(frozen=True, slots=True)
class Series:
    """Two or more log messages that look like a timer's, logged while nobody called the service."""

    key: Key
    ticks: tuple[Tick, ...]

    @property
    def span_s(self) -> float:
        """Seconds from the first message to the last."""
        return self.ticks[-1].stamp - self.ticks[0].stamp

    @property
    def interval_s(self) -> float:
        """The mean interval between two messages."""
        return self.span_s / (len(self.ticks) - 1)

    @property
    def longest_s(self) -> float:
        """The longest interval between two messages."""
        return max(b.stamp - a.stamp for a, b in pairwise(self.ticks))

    @property
    def numbered(self) -> bool:
        """Whether the messages carry the tick's number."""
        return self.ticks[0].number is not None

    @property
    def hz(self) -> float:
        """Ticks per second: by the tick numbers, or if there are none, by the count of messages."""
        return self.hz_in(self.ticks)

    def hz_in(self, ticks: Sequence[Tick]) -> float:
        """Ticks per second in other messages of this series."""
        return hz_of(ticks, starts_over=self.key.kind != "function")

    @property
    def is_10_hz(self) -> bool:
        """Whether this is a 10 Hz timer, within the tolerance."""
        return abs(self.hz - HZ) <= TOLERANCE * HZ

    def __str__(self) -> str:
        basis = "by the number in them" if self.numbered else "by their count"
        return f"{self.hz:.1f} ticks/s {basis}, {len(self.ticks)} messages in {self.span_s:.1f} s"


def timer_series(found: Sequence[Series]) -> tuple[Series, ...]:
    """The series of 10 Hz, or else the likeliest one of another pace.

    A series whose messages are a proper subset of another one's is left out: the timer logs more than that.
    """
    at_10_hz = [series for series in found if series.is_10_hz]
    if not at_10_hz:
        likeliest = best_series(found)
        return (likeliest,) if likeliest else ()
    stamps = {series: {tick.stamp for tick in series.ticks} for series in at_10_hz}
    return tuple(series for series in at_10_hz if not any(stamps[series] < stamps[other] for other in at_10_hz))


def best_series(found: Iterable[Series]) -> Series | None:
    """The series that is most likely the timer's: preferably of 10 Hz, then with tick numbers, then the longest."""
    return max(found, key=lambda series: (series.is_10_hz, series.numbered, len(series.ticks)), default=None)


def all_series(logs: Iterable[LogRecord]) -> list[Series]:
    """All possible series of repeated messages in these logs."""
    ordered = sorted(logs, key=lambda log: log.stamp)[-MAX_MESSAGES:]
    found = _series_by_wording(ordered)
    names = {log.name for log in ordered}
    if len(names) > 1:  # two nodes may use the same words
        for name in names:
            found += _series_by_wording([log for log in ordered if log.name == name], name)
    places: dict[tuple[str, str], list[LogRecord]] = defaultdict(list)
    for log in ordered:
        places[log.name, log.function].append(log)
    for (name, function), own_logs in places.items():
        if function:
            found += _series_of_function(name, function, own_logs, found)
    return found


def _series_by_wording(ordered: Sequence[LogRecord], name: str | None = None) -> list[Series]:
    """The series of messages with common words, of one logger or of all."""
    shapes: dict[str, list[LogRecord]] = defaultdict(list)
    words: dict[str, list[LogRecord]] = defaultdict(list)
    for log in ordered:
        shapes[shape_of(log.text)].append(log)
        for word in {label for label, _ in numbers(log.text) if has_word(label)}:
            words[word].append(log)
    found: list[Series] = []
    for text, alike in shapes.items():
        columns = range(min(len(numbers(log.text)) for log in alike))
        numbered = [s for c in columns if (s := _if_counting(_make_series(Key("shape", text, c, name=name), alike)))]
        found += numbered or _as_list(_if_long(_make_series(Key("shape", text, name=name), alike)))
    for word, alike in words.items():
        found += _as_list(_if_counting(_make_series(Key("word", word, name=name), alike)))
    plain = frozenset(series.key.text for series in found if series.key.kind == "shape" and not series.numbered)
    if len(plain) > 1:
        found += _as_list(_if_regular(_make_series(Key("any", shapes=plain, name=name), ordered)))
    for word in {first_word(text) for text in plain} - {""}:
        found += _as_list(_if_regular(_make_series(Key("begin", word, name=name), ordered)))
    return found


def _series_of_function(
    name: str, function: str, own_logs: Sequence[LogRecord], found: Sequence[Series]
) -> list[Series]:
    """The series of all messages of one function, in any wording: by a common counter, else if regular in time."""
    keys = (Key("function", function, column, name=name) for column in (0, -1))
    if counted := [series for key in keys if (series := _if_counting(_make_series(key, own_logs)))]:
        return counted
    stamps = {log.stamp for log in own_logs}
    if any(s.numbered and sum(t.stamp in stamps for t in s.ticks) >= COVERED_SHARE * len(own_logs) for s in found):
        return []
    return _as_list(_if_regular(_make_series(Key("function", function, name=name), own_logs)))


def _make_series(key: Key, logs: Iterable[LogRecord]) -> Series | None:
    ticks = tuple(tick for log in logs if (tick := key.of(log)))
    return Series(key, ticks) if len(ticks) > 1 and ticks[-1].stamp - ticks[0].stamp >= MIN_SPAN_S else None


def _if_counting(series: Series | None) -> Series | None:
    """The series, if its numbers are a counter: whole, steadily rising (or falling), and not a clock."""
    if series is None:
        return None
    numbers = [tick.number or 0.0 for tick in series.ticks]
    steps = [b - a for a, b in pairwise(numbers)]
    # Overlapping callbacks may log two ticks in the wrong order, but a number that keeps starting over is no counter.
    one_way = abs(numbers[-1] - numbers[0]) >= 0.8 * sum(map(abs, steps)) and sum(map(bool, steps)) >= 0.8 * len(steps)
    whole = all(tick.whole for tick in series.ticks) or series.is_10_hz  # "12.0 ticks" is a count, "1.2 s" a time
    if not one_way or not whole:
        return None
    return None if any(abs(series.hz - clock) <= 0.1 * clock for clock in CLOCKS_HZ) else series


def _if_long(series: Series | None) -> Series | None:
    return series if series and len(series.ticks) > 2 else None


def _if_regular(series: Series | None) -> Series | None:
    """The series, if its messages are regular in time: one per tick in several wordings, not several per tick."""
    if series is None or len(series.ticks) < 4:
        return None
    steps = [b.stamp - a.stamp for a, b in pairwise(series.ticks)]
    usual = median(steps)
    near = sum(abs(step - usual) <= EVEN_SHARE * usual for step in steps)
    return series if near >= 0.8 * len(steps) else None


def _as_list(series: Series | None) -> list[Series]:
    return [] if series is None else [series]


def hz_of(ticks: Sequence[Tick], *, starts_over: bool = True) -> float:
    """Ticks per second from the first message to the last: by the numbers in them, or else by their count.

    With `starts_over`, an interval in which the number starts over is left out, since its ticks are unknown. Among
    messages of different wording a falling number is just a different one, so no interval is left out.
    """
    if any(tick.number is None for tick in ticks):
        return _per_second([(b.stamp - a.stamp, 1.0) for a, b in pairwise(ticks)])
    steps = [(b.stamp - a.stamp, (b.number or 0.0) - (a.number or 0.0)) for a, b in pairwise(ticks)]
    down = sum(step < 0 for _, step in steps) > len(steps) / 2
    steps = [(for_s, -step if down else step) for for_s, step in steps]
    return abs(_per_second([(for_s, step) for for_s, step in steps if step >= -RESTART_STEP or not starts_over]))


def _per_second(steps: Sequence[tuple[float, float]]) -> float:
    span = sum(for_s for for_s, _ in steps)
    return sum(step for _, step in steps) / span if span > 0 else 0.0
