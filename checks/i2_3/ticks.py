"""I2.3: which log messages are the timer's, and how fast they say it ticks.

A learner logs every tick or every tenth, with its number or without, in any words and beside any other messages. So
the timer's messages are found by what they must be: alike, repeated while nobody calls, and ten ticks a second.
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
"""Messages of different wording are one series if most intervals are within this share of their median."""

CLOCKS_HZ = (1e3, 1e6, 1e9)
"""A number that rises at one of these speeds is a time in ms, µs or ns, not a count of ticks."""

MIN_SPAN_S = 0.9
"""What comes again and again within less than this, and then no more, is a greeting."""

MAX_MESSAGES = 2000
"""Of a flood of messages, the latest will do."""

STARTS_OVER = 2
"""A number that falls back by more than this starts over; by less, callbacks that overlap were logged out of turn."""

NEARLY_ALL = 0.8
"""This share of a function's messages tells how fast it counts."""


@dataclass(frozen=True, slots=True)
class Series:
    """Log messages that look like a timer's, logged while nobody called the service. `ticks` are two or more."""

    key: Key
    ticks: tuple[Tick, ...]

    @property
    def span_s(self) -> float:
        """Seconds from the first message to the last."""
        return self.ticks[-1].stamp - self.ticks[0].stamp

    @property
    def interval_s(self) -> float:
        """The mean time between two messages."""
        return self.span_s / (len(self.ticks) - 1)

    @property
    def longest_s(self) -> float:
        """The longest time between two messages."""
        return max(b.stamp - a.stamp for a, b in pairwise(self.ticks))

    @property
    def numbered(self) -> bool:
        """Whether the messages carry the tick's number."""
        return self.ticks[0].number is not None

    @property
    def hz(self) -> float:
        """Ticks in a second: by the tick's number, or where there is none, by the messages."""
        return self.hz_in(self.ticks)

    def hz_in(self, ticks: Sequence[Tick]) -> float:
        """The same of other messages of this series."""
        return hz_of(ticks, starts_over=self.key.kind != "function")

    @property
    def is_10_hz(self) -> bool:
        """Whether this is a timer of 10 Hz, within the tolerance."""
        return abs(self.hz - HZ) <= TOLERANCE * HZ

    def __str__(self) -> str:
        by = "by the number in them" if self.numbered else "by their count"
        return f"{self.hz:.1f} ticks/s {by}, {len(self.ticks)} messages in {self.span_s:.1f} s"


def timer_series(found: Sequence[Series]) -> tuple[Series, ...]:
    """Those that are of 10 Hz, or else the likeliest of another pace.

    Messages that are some of another series' are not all that the timer logs, and left out.
    """
    right = [series for series in found if series.is_10_hz]
    if not right:
        one = best_series(found)
        return (one,) if one else ()
    stamps = {series: {tick.stamp for tick in series.ticks} for series in right}
    return tuple(series for series in right if not any(stamps[series] < stamps[other] for other in right))


def best_series(found: Iterable[Series]) -> Series | None:
    """The series that is most likely the timer's: one with tick numbers, else the one with most messages."""
    return max(found, key=lambda series: (series.is_10_hz, series.numbered, len(series.ticks)), default=None)


def all_series(logs: Iterable[LogRecord]) -> list[Series]:
    """Every way to see repeated messages in these logs."""
    ordered = sorted(logs, key=lambda log: log.stamp)[-MAX_MESSAGES:]
    found = _alike(ordered)
    names = {log.name for log in ordered}
    if len(names) > 1:  # two nodes may use the same words
        for name in names:
            found += _alike([log for log in ordered if log.name == name], name)
    places: dict[tuple[str, str], list[LogRecord]] = defaultdict(list)
    for log in ordered:
        places[log.name, log.function].append(log)
    for (name, function), theirs in places.items():
        if function:
            found += _of_function(name, function, theirs, found)
    return found


def _alike(ordered: Sequence[LogRecord], name: str | None = None) -> list[Series]:
    """The series of messages with words in common, of one logger or all."""
    shapes: dict[str, list[LogRecord]] = defaultdict(list)
    words: dict[str, list[LogRecord]] = defaultdict(list)
    for log in ordered:
        shapes[shape_of(log.text)].append(log)
        for word in {label for label, _ in numbers(log.text) if has_word(label)}:
            words[word].append(log)
    found: list[Series] = []
    for text, alike in shapes.items():
        columns = range(min(len(numbers(log.text)) for log in alike))
        numbered = [s for c in columns if (s := _counting(_series(Key("shape", text, c, name=name), alike)))]
        found += numbered or _some(_uncounted(_series(Key("shape", text, name=name), alike)))
    for word, alike in words.items():
        found += _some(_counting(_series(Key("word", word, name=name), alike)))
    plain = frozenset(series.key.text for series in found if series.key.kind == "shape" and not series.numbered)
    if len(plain) > 1:
        found += _some(_even(_series(Key("any", shapes=plain, name=name), ordered)))
    for word in {first_word(text) for text in plain} - {""}:
        found += _some(_even(_series(Key("begin", word, name=name), ordered)))
    return found


def _of_function(name: str, function: str, theirs: Sequence[LogRecord], found: Sequence[Series]) -> list[Series]:
    """What one function logs, in whatever words: by a number that counts on through all of them, or else as a beat."""
    keys = (Key("function", function, column, name=name) for column in (0, -1))
    if counted := [series for key in keys if (series := _counting(_series(key, theirs)))]:
        return counted
    stamps = {log.stamp for log in theirs}
    if any(s.numbered and sum(t.stamp in stamps for t in s.ticks) >= NEARLY_ALL * len(theirs) for s in found):
        return []
    return _some(_even(_series(Key("function", function, name=name), theirs)))


def _series(key: Key, logs: Iterable[LogRecord]) -> Series | None:
    ticks = tuple(tick for log in logs if (tick := key.of(log)))
    return Series(key, ticks) if len(ticks) > 1 and ticks[-1].stamp - ticks[0].stamp >= MIN_SPAN_S else None


def _counting(series: Series | None) -> Series | None:
    """The series, where its numbers count something: whole, rising (or falling) on and on, but no clock."""
    if series is None:
        return None
    numbers = [tick.number or 0.0 for tick in series.ticks]
    steps = [b - a for a, b in pairwise(numbers)]
    # Callbacks that overlap may log two ticks in the wrong order; a number that starts over counts nothing.
    one_way = abs(numbers[-1] - numbers[0]) >= 0.8 * sum(map(abs, steps)) and sum(map(bool, steps)) >= 0.8 * len(steps)
    whole = all(tick.whole for tick in series.ticks) or series.is_10_hz  # "12.0 ticks" counts, "1.2 s" tells the time
    if not one_way or not whole:
        return None
    return None if any(abs(series.hz - clock) <= 0.1 * clock for clock in CLOCKS_HZ) else series


def _uncounted(series: Series | None) -> Series | None:
    return series if series and len(series.ticks) > 2 else None


def _even(series: Series | None) -> Series | None:
    """The series, where it is one beat in several wordings, not several messages at each beat."""
    if series is None or len(series.ticks) < 4:
        return None
    steps = [b.stamp - a.stamp for a, b in pairwise(series.ticks)]
    usual = median(steps)
    near = sum(abs(step - usual) <= EVEN_SHARE * usual for step in steps)
    return series if near >= 0.8 * len(steps) else None


def _some(series: Series | None) -> list[Series]:
    return [] if series is None else [series]


def hz_of(ticks: Sequence[Tick], *, starts_over: bool = True) -> float:
    """Ticks in a second, from the first message to the last: by the numbers in them, or by their count.

    Where the number `starts_over`, nobody knows how many ticks there were, and that interval is left out. In messages
    of other words, one that does is another number.
    """
    if any(tick.number is None for tick in ticks):
        return _per_second([(b.stamp - a.stamp, 1.0) for a, b in pairwise(ticks)])
    steps = [(b.stamp - a.stamp, (b.number or 0.0) - (a.number or 0.0)) for a, b in pairwise(ticks)]
    down = sum(step < 0 for _, step in steps) > len(steps) / 2
    steps = [(for_s, -step if down else step) for for_s, step in steps]
    return abs(_per_second([(for_s, step) for for_s, step in steps if step >= -STARTS_OVER or not starts_over]))


def _per_second(steps: Sequence[tuple[float, float]]) -> float:
    span = sum(for_s for for_s, _ in steps)
    return sum(step for _, step in steps) / span if span > 0 else 0.0
