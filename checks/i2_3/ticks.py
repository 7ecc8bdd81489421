"""I2.3: which log messages are the timer's, and how fast they say it ticks.

A learner logs every tick or every tenth, with its number or without, in any words and beside any other messages. So
the timer's messages are found by what they must be: alike, repeated while nobody calls, and ten ticks a second.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from statistics import median

from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import LogRecord
from tutor.judge.wording import shape

HZ = 10.0

EVEN = 0.5
"""Messages of different wording are one series if most intervals are within this share of their median."""

CLOCKS_HZ = (1e3, 1e6, 1e9)
"""A number that rises at one of these speeds is a time in ms, µs or ns, not a count of ticks."""

LEAST_S = 0.9
"""What comes again and again within less than this, and then no more, is a greeting."""

MOST = 2000
"""Of a flood of messages, the latest will do."""

_NUMBER = re.compile(r"\d+(?:\.\d+)?")
_WORD_BEFORE = re.compile(r"\w*\W*$")
_WORD_AFTER = re.compile(r"\W*[^\W\d]+")
_FIRST_WORD = re.compile(r"\W*[^\W\d]{3,}")
_TRUTH = re.compile(r"\b(true|false|yes|no|on|off|idle|busy)\b", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Tick:
    """One log message of a series: when it was logged (seconds since the epoch), and the tick number in it, if any.

    `whole`: the number is written without decimals.
    """

    stamp: float
    number: float | None
    text: str
    whole: bool = True


@dataclass(frozen=True, slots=True)
class Key:
    """What the messages of a series have in common; `of` reads a message, and gives None for one of another series."""

    kind: str
    text: str = ""
    column: int | None = None
    shapes: frozenset[str] = frozenset()

    def of(self, log: LogRecord) -> Tick | None:
        """The tick that this message tells of, where it belongs to the series."""
        if self.kind == "word":
            found = next((each for each in _numbers(log.text) if each[0] == self.text), None)
            return _tick(log, found[1]) if found else None
        if self.kind == "any" and _shape(log.text) in self.shapes:
            return _tick(log, None)
        if self.kind == "begin" and _first_word(log.text) == self.text:
            return _tick(log, None)
        if self.kind == "shape" and _shape(log.text) == self.text:
            return _tick(log, None if self.column is None else _numbers(log.text)[self.column][1])
        return None


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
        return hz_of(self.ticks)

    @property
    def is_10_hz(self) -> bool:
        """Whether this is a timer of 10 Hz, within the tolerance."""
        return abs(self.hz - HZ) <= TOLERANCE * HZ

    def __str__(self) -> str:
        by = "by the number in them" if self.numbered else "by their count"
        return f"{self.hz:.1f} ticks/s {by}, {len(self.ticks)} messages in {self.span_s:.1f} s"


def likely(found: Sequence[Series]) -> tuple[Series, ...]:
    """Those that are of 10 Hz, or else the likeliest of another pace.

    Messages that are some of another series' are not all that the timer logs, and left out.
    """
    right = [series for series in found if series.is_10_hz]
    if not right:
        one = best(found)
        return (one,) if one else ()
    stamps = {series: {tick.stamp for tick in series.ticks} for series in right}
    return tuple(series for series in right if not any(stamps[series] < stamps[other] for other in right))


def best(found: Iterable[Series]) -> Series | None:
    """The series that is most likely the timer's: one with tick numbers, else the one with most messages."""
    return max(found, key=lambda series: (series.is_10_hz, series.numbered, len(series.ticks)), default=None)


def all_series(logs: Iterable[LogRecord]) -> list[Series]:
    """Every way to see repeated messages in these logs."""
    ordered = sorted(logs, key=lambda log: log.stamp)[-MOST:]
    shapes: dict[str, list[LogRecord]] = defaultdict(list)
    words: dict[str, list[LogRecord]] = defaultdict(list)
    for log in ordered:
        shapes[_shape(log.text)].append(log)
        for word in {label for label, _ in _numbers(log.text) if _has_word(label)}:
            words[word].append(log)
    found: list[Series] = []
    for text, alike in shapes.items():
        columns = range(min(len(_numbers(log.text)) for log in alike))
        numbered = [s for c in columns if (s := _counting(_series(Key("shape", text, c), alike)))]
        found += numbered or _some(_uncounted(_series(Key("shape", text), alike)))
    for word, alike in words.items():
        found += _some(_counting(_series(Key("word", word), alike)))
    plain = frozenset(series.key.text for series in found if series.key.kind == "shape" and not series.numbered)
    if len(plain) > 1:
        found += _some(_even(_series(Key("any", shapes=plain), ordered)))
    for word in {_first_word(text) for text in plain} - {""}:
        found += _some(_even(_series(Key("begin", word), ordered)))
    return found


def _series(key: Key, logs: Iterable[LogRecord]) -> Series | None:
    ticks = tuple(tick for log in logs if (tick := key.of(log)))
    return Series(key, ticks) if len(ticks) > 1 and ticks[-1].stamp - ticks[0].stamp >= LEAST_S else None


def _counting(series: Series | None) -> Series | None:
    """The series, where its numbers count something: whole, rising (or falling) on and on, but no clock."""
    if series is None:
        return None
    numbers = [tick.number or 0.0 for tick in series.ticks]
    steps = [b - a for a, b in pairwise(numbers)]
    # Callbacks that overlap may tell of two ticks in the wrong order; a number that starts over counts nothing.
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
    near = sum(abs(step - usual) <= EVEN * usual for step in steps)
    return series if near >= 0.8 * len(steps) else None


def _some(series: Series | None) -> list[Series]:
    return [] if series is None else [series]


def hz_of(ticks: Sequence[Tick]) -> float:
    """Ticks in a second, from the first message to the last: by the numbers in them, or by their count."""
    first, last = ticks[0], ticks[-1]
    span = last.stamp - first.stamp
    if span <= 0:
        return 0.0
    if first.number is None or last.number is None:
        return (len(ticks) - 1) / span
    return abs(last.number - first.number) / span


@lru_cache(4 * MOST)
def _shape(text: str) -> str:
    return _TRUTH.sub("?", shape(text))


def _tick(log: LogRecord, written: str | None) -> Tick:
    if written is None:
        return Tick(log.stamp, None, log.text)
    return Tick(log.stamp, float(written), log.text, "." not in written)


@lru_cache(4 * MOST)
def _numbers(text: str) -> tuple[tuple[str, str], ...]:
    """The numbers in a text, each with its label: the word right before it, or where there is none, the one after."""
    found: list[tuple[str, str]] = []
    end = 0
    for match in _NUMBER.finditer(text):
        before = _WORD_BEFORE.search(text[end : match.start()])
        label = before.group() if before else ""
        if not _has_word(label):
            after = _WORD_AFTER.match(text[match.end() :])
            label += "0" + after.group() if after else ""
        found.append((label, match.group()))
        end = match.end()
    return tuple(found)


def _has_word(label: str) -> bool:
    return any(map(str.isalpha, label))


def _first_word(text: str) -> str:
    words = _FIRST_WORD.match(text)
    return words.group().casefold() if words else ""
