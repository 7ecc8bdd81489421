"""I2.3: features of log messages that those of one timer have in common.

Not only the wording counts, but also the origin: one function may word its messages in many ways.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from tutor.judge.trace import LogRecord
from tutor.judge.wording import shape

CACHE_SIZE = 8000
"""Number of parsed texts to cache: a flood of messages is analysed repeatedly."""

_NUMBER = re.compile(r"\d+(?:\.\d+)?")
_WORD_BEFORE = re.compile(r"\w*\W*$")
_WORD_AFTER = re.compile(r"\W*[^\W\d]+")
_FIRST_WORD = re.compile(r"\W*[^\W\d]{3,}")
_STATE = re.compile(r"\b(true|false|yes|no|on|off|idle|busy)\b", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Tick:
    """One log message of a series. `stamp`: seconds since the epoch; `number`: the tick number in it, if any.

    `whole`: the number is written without decimals.
    """

    stamp: float
    number: float | None
    text: str
    whole: bool = True


@dataclass(frozen=True, slots=True)
class Key:
    """What the messages of a series have in common.

    `kind`: "shape" (the same wording), "word" (a number with the same label), "begin" (the same first word), "any" (one
    of several `shapes`) or "function" (logged by the same function). `text`: that shape, label, word or function.
    `name`: the logger's name, if it matters; `column`: the index of the tick number among the message's numbers.
    """

    kind: str
    text: str = ""
    column: int | None = None
    shapes: frozenset[str] = frozenset()
    name: str | None = None

    def of(self, log: LogRecord) -> Tick | None:
        """The tick that this message reports; None if it does not belong to the series."""
        if self.name not in (None, log.name):
            return None
        if self.kind == "function" and log.function == self.text:
            found = numbers(log.text)
            if self.column is None:
                return _tick(log, None)
            return _tick(log, found[self.column][1]) if found else None
        if self.kind == "word":
            labelled = next((each for each in numbers(log.text) if each[0] == self.text), None)
            return _tick(log, labelled[1]) if labelled else None
        if self.kind == "any" and shape_of(log.text) in self.shapes:
            return _tick(log, None)
        if self.kind == "begin" and first_word(log.text) == self.text:
            return _tick(log, None)
        if self.kind == "shape" and shape_of(log.text) == self.text:
            return _tick(log, None if self.column is None else numbers(log.text)[self.column][1])
        return None


@lru_cache(CACHE_SIZE)
def shape_of(text: str) -> str:
    """The wording of a message, without numbers and without words for a state such as "on" or "idle"."""
    return _STATE.sub("?", shape(text))


def _tick(log: LogRecord, written: str | None) -> Tick:
    if written is None:
        return Tick(log.stamp, None, log.text)
    return Tick(log.stamp, float(written), log.text, "." not in written)


@lru_cache(CACHE_SIZE)
def numbers(text: str) -> tuple[tuple[str, str], ...]:
    """The numbers in a text as (label, number). The label is the word right before it, or else the one after it."""
    found: list[tuple[str, str]] = []
    end = 0
    for match in _NUMBER.finditer(text):
        before = _WORD_BEFORE.search(text[end : match.start()])
        label = before.group() if before else ""
        if not has_word(label):
            after = _WORD_AFTER.match(text[match.end() :])
            label += "0" + after.group() if after else ""
        found.append((label.casefold(), match.group()))
        end = match.end()
    return tuple(found)


def has_word(label: str) -> bool:
    """Whether the label contains a letter."""
    return any(map(str.isalpha, label))


def first_word(text: str) -> str:
    """The first word, if it has at least three letters and only punctuation before it; else ""."""
    words = _FIRST_WORD.match(text)
    return words.group().casefold() if words else ""
