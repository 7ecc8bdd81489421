"""I2.3: find the timer's log messages.

A learner may log every tick or every tenth, with its number or without, in any words, and among any other messages. So
the timer's messages are recognised by their properties: alike, repeated while nobody calls, and ten ticks per second.
Not only the wording counts, but also the origin: one function may word its messages in many ways.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from statistics import median

from tutor.judge.rates import TOLERANCE
from tutor.judge.trace import LogRecord
from tutor.judge.wording import shape

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

CACHE_SIZE = 8000
"""Number of parsed texts to cache: a flood of messages is analysed repeatedly."""

_NUMBER = re.compile(r"\d+(?:\.\d+)?")
_WORD_BEFORE = re.compile(r"\w*\W*$")
_WORD_AFTER = re.compile(r"\W*[^\W\d]+")
_FIRST_WORD = re.compile(r"\W*[^\W\d]{3,}")
_STATE = re.compile(r"\b(true|false|yes|no|on|off|idle|busy)\b", re.IGNORECASE)


@lru_cache(CACHE_SIZE)
def wording(text: str) -> str:
    """A message without its numbers, and without words for a state such as "on" or "idle"."""
    return _STATE.sub("?", shape(text))


@lru_cache(CACHE_SIZE)
def numbers(text: str) -> tuple[tuple[str, str], ...]:
    """The numbers in a text as (label, number). The label is the word right before it, or else the one after it."""
    found: list[tuple[str, str]] = []
    end = 0
    for match in _NUMBER.finditer(text):
        before = _WORD_BEFORE.search(text[end : match.start()])
        label = before.group() if before else ""
        if not _has_word(label):
            after = _WORD_AFTER.match(text[match.end() :])
            label += "0" + after.group() if after else ""
        found.append((label.casefold(), match.group()))
        end = match.end()
    return tuple(found)


def _has_word(label: str) -> bool:
    return any(map(str.isalpha, label))


def first_word(text: str) -> str:
    """The first word, if it has at least three letters and only punctuation before it; else ""."""
    words = _FIRST_WORD.match(text)
    return words.group().casefold() if words else ""


FEATURES: Mapping[str, Callable[[LogRecord], Collection[str]]] = {
    "wording": lambda log: (wording(log.text),),
    "label": lambda log: [label for label, _ in numbers(log.text) if _has_word(label)],
    "first word": lambda log: (first_word(log.text),),
    "function": lambda log: (log.function,),
}
"""What messages can have in common: a wording, the label of a number, the first word, the function that logs them."""


@dataclass(frozen=True, slots=True)
class Tick:
    """One log message of a series. `stamp`: seconds since the epoch; `number`: the tick number in it, or 0.

    `whole`: the number is written without decimals.
    """

    stamp: float
    number: float
    text: str
    whole: bool = True


@dataclass(frozen=True, slots=True)
class Key:
    """What the messages of a series have in common: a feature of `FEATURES` that is one of `texts`.

    `number`: which number in a message counts the ticks, by its place or its label; None if none does. `name`: the
    logger's name, if it matters.
    """

    feature: str
    texts: frozenset[str]
    number: int | str | None = None
    name: str | None = None

    def of(self, log: LogRecord) -> Tick | None:
        """The tick that this message reports; None if it does not belong to the series."""
        if self.name not in (None, log.name) or self.texts.isdisjoint(FEATURES[self.feature](log)):
            return None
        if self.number is None:
            return Tick(log.stamp, 0.0, log.text)
        written = self._number_in(log.text)
        return None if written is None else Tick(log.stamp, float(written), log.text, "." not in written)

    def _number_in(self, text: str) -> str | None:
        found = numbers(text)
        if isinstance(self.number, int):
            return found[self.number][1] if found[self.number :] else None
        return next((written for label, written in found if label == self.number), None)


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
        return self.key.number is not None

    @property
    def hz(self) -> float:
        """Ticks per second: by the tick numbers, or if there are none, by the count of messages."""
        return self.hz_in(self.ticks)

    def hz_in(self, ticks: Sequence[Tick]) -> float:
        """Ticks per second in other messages of this series.

        An interval in which the number starts over is left out, since its ticks are unknown. Among messages of
        different wording, which only a function has in common, a falling number is just another one.
        """
        steps = [(b.stamp - a.stamp, b.number - a.number if self.numbered else 1.0) for a, b in pairwise(ticks)]
        if 2 * sum(step < 0 for _, step in steps) > len(steps):  # it counts down
            steps = [(for_s, -step) for for_s, step in steps]
        known = [(for_s, step) for for_s, step in steps if step >= -RESTART_STEP or self.key.feature == "function"]
        span_s = sum(for_s for for_s, _ in known)
        return abs(sum(step for _, step in known)) / span_s if span_s > 0 else 0.0

    @property
    def is_10_hz(self) -> bool:
        """Whether this is a 10 Hz timer, within the tolerance."""
        return abs(self.hz - HZ) <= TOLERANCE * HZ

    def is_long(self) -> bool:
        """Whether these messages are more than a pair that happens to be alike."""
        return len(self.ticks) > 2

    def is_counting(self) -> bool:
        """Whether the numbers are a counter: whole, steadily rising (or falling), and not a clock."""
        steps = [b.number - a.number for a, b in pairwise(self.ticks)]
        # Overlapping callbacks may log two ticks out of order, but a number that keeps starting over is no counter.
        one_way = abs(sum(steps)) >= 0.8 * sum(map(abs, steps)) and sum(map(bool, steps)) >= 0.8 * len(steps)
        whole = all(tick.whole for tick in self.ticks) or self.is_10_hz  # "12.0 ticks" is a count, "1.2 s" a time
        return one_way and whole and not any(abs(self.hz - clock) <= 0.1 * clock for clock in CLOCKS_HZ)

    def is_regular(self) -> bool:
        """Whether the messages are regular in time: one per tick in several wordings, not several per tick."""
        steps = [b.stamp - a.stamp for a, b in pairwise(self.ticks)]
        usual = median(steps)
        near = sum(abs(step - usual) <= EVEN_SHARE * usual for step in steps)
        return len(steps) >= 3 and near >= 0.8 * len(steps)

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
    names = dict.fromkeys(log.name for log in ordered)
    for name in names if len(names) > 1 else ():  # two nodes may use the same words
        found += _series_by_wording([log for log in ordered if log.name == name], name)
    for name in names:
        own_logs = [log for log in ordered if log.name == name and log.function]
        for function, logged in _grouped("function", own_logs).items():
            found += _series_of_function(Key("function", frozenset({function}), name=name), logged, found)
    return found


def _series_by_wording(logs: Sequence[LogRecord], name: str | None = None) -> list[Series]:
    """The series of messages with common words, of one logger or of all."""
    found: list[Series] = []
    for text, alike in _grouped("wording", logs).items():
        key = Key("wording", frozenset({text}), name=name)
        places = range(min(len(numbers(log.text)) for log in alike))
        counted = [s for place in places for s in _series(replace(key, number=place), alike, Series.is_counting)]
        found += counted or _series(key, alike, Series.is_long)
    plain = frozenset(text for series in found if not series.numbered for text in series.key.texts)
    for label, alike in _grouped("label", logs).items():
        found += _series(Key("label", frozenset({label}), label, name), alike, Series.is_counting)
    if len(plain) > 1:
        found += _series(Key("wording", plain, name=name), logs, Series.is_regular)
    for word in {first_word(text) for text in plain} - {""}:
        found += _series(Key("first word", frozenset({word}), name=name), logs, Series.is_regular)
    return found


def _series_of_function(key: Key, logged: Sequence[LogRecord], found: Sequence[Series]) -> list[Series]:
    """The series of all messages of one function, in any wording: by a common counter, else if regular in time."""
    if counted := [s for place in (0, -1) for s in _series(replace(key, number=place), logged, Series.is_counting)]:
        return counted
    stamps = {log.stamp for log in logged}
    if any(s.numbered and sum(t.stamp in stamps for t in s.ticks) >= COVERED_SHARE * len(logged) for s in found):
        return []
    return _series(key, logged, Series.is_regular)


def _grouped(feature: str, logs: Iterable[LogRecord]) -> dict[str, list[LogRecord]]:
    groups: dict[str, list[LogRecord]] = defaultdict(list)
    for log in logs:
        for text in dict.fromkeys(FEATURES[feature](log)):
            groups[text].append(log)
    return groups


def _series(key: Key, logs: Iterable[LogRecord], suits: Callable[[Series], bool]) -> list[Series]:
    """The series of these messages, if there is one that `suits`."""
    series = Series(key, tuple(tick for log in logs if (tick := key.of(log))))
    return [series] if len(series.ticks) > 1 and series.span_s >= MIN_SPAN_S and suits(series) else []
