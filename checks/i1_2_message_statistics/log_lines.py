"""I1.2: parse log messages into quoted messages, numbers and wording.

This works in any language and format, since no particular words are assumed.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

from tutor.judge.trace import LogRecord

_COLOUR = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")
_CONTENT = re.compile(r"Hello World:\s*(\d+)", re.IGNORECASE)
_CLOCK = re.compile(r"\d{4}-\d\d-\d\d(?:[T ]\d\d:\d\d(?::\d\d(?:[.,]\d+)?)?)?|(?<!\d)\d+:\d\d:\d\d(?:[.,]\d+)?")
_NUMBER = re.compile(r"(?:(?<![\w.,)\]])[-\u2212])?\d+(?:[.,]\d+|['\u2019_]\d{3}(?!\d))*(?:[eE][-+]?\d+)?")
_THOUSANDS = re.compile(r"['\u2019_]")
_IN_ENGLISH = re.compile(r"-?\d{1,3}(,\d{3})+(\.\d+)?")
_IN_GERMAN = re.compile(r"-?\d{1,3}(\.\d{3})+,\d+")
_LABEL = re.compile(
    r"\b(?:(?P<first>first|erste[rns]?|premi[eè]re?|primer[ao]?|prim[ao])|(?:last|latest|letzte[rns]?|derni[eè]re?|[uú]ltim[ao]))"
    r"[\s_-]*+(?:[^\W\d]++\s*+)?[\"']?\s*+[:=]\s*+[^\w\s]*$",
    re.IGNORECASE,
)
_PER_SECOND = re.compile(  # right after a number, and not the label of the next one
    r"[ _]*(?:[^\W\d]{1,12}\.?[ _]*)?(?:/ ?(?:s|secs?|seconds?|sek|sekunde|秒)|(?:per|pro|par|por|al)[ _](?:sec|second|"
    r"sekunde|seconde|segundo|secondo)|hz)\b(?!\s*(?:[:=]|\(?-?\d))",
    re.IGNORECASE,
)
_DIGITS = re.compile(r"(?<![0-9A-Za-z#])[0-9A-Za-z]*+#[0-9A-Za-z#]*")  # of an identifier, such as 0x5f3a
_REPEATED = re.compile(r"(.)\1+")


@dataclass(frozen=True, slots=True)
class Number:
    """A number as written, and all values that it may stand for: "4,93" is 4.93, or 4 and 93.

    `per_second`: whether its unit says that it is a rate, as in "4.93 messages per second".
    """

    text: str
    values: tuple[float, ...]
    per_second: bool = False

    @property
    def value(self) -> float:
        """The likeliest value."""
        return self.values[0]


@dataclass(frozen=True, slots=True)
class Line:
    """One log message. `messages`: how many messages had been sent to the node when it was logged.

    `shape`: its wording, without quotations and numbers; `quoted`: the N of each “Hello World: N” that it quotes; `at`:
    when it was logged, in seconds since the epoch.
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
        """Level and shape: log messages of one kind probably come from the same line of code."""
        return self.level, self.shape

    @property
    def tells(self) -> bool:
        """Whether the line contains more than wording."""
        return bool(self.quoted or self.numbers)


def parse_log(log: LogRecord, messages: int) -> Line:
    """Parse one log message, logged after `messages` messages had been sent."""
    text = unicodedata.normalize("NFKC", _COLOUR.sub("", log.text))
    quoted = tuple(int(found[1]) for found in _CONTENT.finditer(text))
    plain = _CLOCK.sub("@", _CONTENT.sub("“”", text))
    numbers = tuple(number for number in _find_numbers(plain) if all(map(math.isfinite, number.values)))
    shape = _REPEATED.sub(r"\1", re.sub(r"\s+", " ", _DIGITS.sub("#", _NUMBER.sub("#", plain)))).strip()
    return Line(log.level, shape, text, log.stamp, messages, quoted, numbers)


def labelled(text: str) -> Iterator[tuple[str, int]]:
    """The quotations right after "first" or "last", such as last message: "...", as (label, N)."""
    end = 0
    for found in _CONTENT.finditer(text):
        if label := _LABEL.search(text[end : found.start()]):
            yield "first" if label["first"] else "last", int(found[1])
        end = found.end()


def _find_numbers(plain: str) -> Iterator[Number]:
    for found in _NUMBER.finditer(plain):
        *others, last = _split_list(found[0])
        yield from others
        yield replace(last, per_second=_PER_SECOND.match(plain, found.end()) is not None)


def _split_list(written: str) -> Iterator[Number]:
    """The numbers in a list without spaces, such as 10,4.95,0; each may also have the next one as its decimals.

    Text that may be a single number is taken for one.
    """
    parts = _normalise(written).split(",")
    one = len(parts) < 3 and "." not in written
    if one or _IN_ENGLISH.fullmatch(written) or _IN_GERMAN.fullmatch(written):
        yield Number(written, tuple(values(written)))
        return
    for part, decimals in pairwise([*parts, "."]):
        more = () if "." in part + decimals else (float(f"{part}.{decimals}"),)
        yield Number(part, (*values(part), *more))


def _normalise(written: str) -> str:
    """Replace a typographic minus sign by a hyphen, and remove thousands separators."""
    return _THOUSANDS.sub("", written.replace("\u2212", "-"))


def values(written: str) -> Iterator[float]:
    """All values that a number may stand for, the likeliest first. A comma may be a decimal point or a separator."""
    text = _normalise(written)
    if _IN_ENGLISH.fullmatch(text):
        yield float(text.replace(",", ""))
    if _IN_GERMAN.fullmatch(text):
        yield float(text.replace(".", "").replace(",", "."))
    parts = text.split(",")
    if len(parts) > 1:
        for whole, decimals in pairwise(parts):
            if "." not in whole + decimals:
                yield float(f"{whole}.{decimals}")
    for part in parts:
        for piece in [part] if part.count(".") < 2 else part.split("."):
            yield float(piece)
