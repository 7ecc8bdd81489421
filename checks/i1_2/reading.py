"""Log messages read as a human reads them: what is quoted, what is a number, and what is only wording.

In any language and any format: nothing is known of the words.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from tutor.judge.trace import LogRecord

_COLOUR = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")
_CONTENT = re.compile(r"Hello World:\s*(\d+)", re.IGNORECASE)
_CLOCK = re.compile(r"\d{4}-\d\d-\d\d(?:[T ]\d\d:\d\d(?::\d\d(?:[.,]\d+)?)?)?|\d+:\d\d:\d\d(?:[.,]\d+)?")
_NUMBER = re.compile(r"(?:(?<![\w.,)\]])[-\u2212])?\d+(?:[.,'\u2019_\u00a0\u202f]\d+)*(?:[eE][-+]?\d+)?")
_THOUSANDS = re.compile(r"['\u2019_\u00a0\u202f](?=\d{3})")
_DIGITS = re.compile(r"[0-9A-Za-z#]*#[0-9A-Za-z#]*")  # of an identifier, such as 0x5f3a
_REPEATED = re.compile(r"(.)\1+")


@dataclass(frozen=True, slots=True)
class Number:
    """A number as it is written, and all values that it may be meant as: "4,93" is 4.93, or 4 and 93."""

    text: str
    values: tuple[float, ...]

    @property
    def value(self) -> float:
        """The likeliest of its values."""
        return self.values[0]


@dataclass(frozen=True, slots=True)
class Line:
    """One log message. `messages`: how many had been sent to the node when it was logged.

    `shape` is its wording, without quotations and numbers; `quoted` holds each N of the contents that it quotes.
    """

    level: int
    shape: str
    text: str
    at: float
    messages: int
    quoted: tuple[int, ...]
    numbers: tuple[Number, ...]

    @property
    def kind(self) -> tuple[int, str]:
        """Two messages of one kind come from the same line of code, as like as not."""
        return self.level, self.shape

    @property
    def tells(self) -> bool:
        """Whether there is more in it than wording."""
        return bool(self.quoted or self.numbers)


def read(log: LogRecord, messages: int) -> Line:
    """Read one log message, logged after so many `messages` had been sent."""
    text = unicodedata.normalize("NFKC", _COLOUR.sub("", log.text))
    quoted = tuple(int(found[1]) for found in _CONTENT.finditer(text))
    plain = _CLOCK.sub("@", _CONTENT.sub("“”", text))
    numbers = tuple(Number(found[0], tuple(values(found[0]))) for found in _NUMBER.finditer(plain))
    shape = _REPEATED.sub(r"\1", re.sub(r"\s+", " ", _DIGITS.sub("#", _NUMBER.sub("#", plain)))).strip()
    return Line(log.level, shape, text, log.stamp, messages, quoted, numbers)


def values(written: str) -> Iterator[float]:
    """All values that a number may be meant as, the likeliest first. A comma may be a decimal point, or an end."""
    text = _THOUSANDS.sub("", written.replace("\u2212", "-"))
    if re.fullmatch(r"-?\d{1,3}(,\d{3})+(\.\d+)?", text):
        yield float(text.replace(",", ""))
    if re.fullmatch(r"-?\d{1,3}(\.\d{3})+,\d+", text):
        yield float(text.replace(".", "").replace(",", "."))
    parts = text.split(",")
    if len(parts) > 1:
        for whole, decimals in pairwise(parts):
            if "." not in whole + decimals:
                yield float(f"{whole}.{decimals}")
    for part in parts:
        for piece in [part] if part.count(".") < 2 else part.split("."):
            yield float(piece)
