"""Known exceptions as data: what each means in a node. A mistake has a page, and one or more ways to recognise it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

WORD = re.compile(r"\{([a-z]\w*)\}")
"""A placeholder in braces, filled in from the exception or from the learner's own line."""

type Words = Mapping[str, str]
"""The values of a way's placeholders, by their names."""


@dataclass(frozen=True, slots=True)
class Replace:
    """What the learner's line becomes, for a slip: `pattern` is replaced by `by`. Both may have placeholders."""

    pattern: str
    by: str


@dataclass(frozen=True, slots=True)
class Example:
    """A case that a way must recognise: the exception raised, the learner's line and file, where it was raised."""

    raised: str
    line: str = ""
    source: str = ""
    function: str = "callback"
    at: str = ""


@dataclass(frozen=True, slots=True)
class Way:
    """One way in which a mistake shows. It is recognised if all of its patterns match; an empty one always does.

    - `type` must match the last part of the exception's name in full; the other patterns are searched for.
    - `text` is searched for in the message, `line` in the learner's own line.
    - `source` must be found in the learner's whole file, and `without` must not.
    - `through` is searched for in "function: line" of each of the learner's frames in the traceback, `at` in "path,
      function" of the frame that raised.
    - `source`, `without` and `replace` may use the groups of `text` and `line`.
    - `look_up` names a table of words. The entry whose key equals the group `name` (or, unless `exact`, comes closest
      to it) becomes the placeholder `found`.
    - `of_source`: show the line that `source` matched (at its group `there`, if it has one), for exceptions from a call
      that rclpy makes.
    - `replace`: for a slip, what that line becomes: the placeholder `becomes`.
    """

    says: str
    do: str
    type: str = ".*"
    text: str = ""
    line: str = ""
    source: str = ""
    without: str = ""
    through: str = ""
    at: str = ""
    replace: Replace | None = None
    look_up: str = ""
    exact: bool = True
    of_source: bool = False
    examples: tuple[Example, ...] = ()
    words: Mapping[str, str] = field(default_factory=dict)

    @property
    def placeholders(self) -> frozenset[str]:
        """The names of all placeholders in `says` and `do`."""
        return frozenset(WORD.findall(f"{self.says} {self.do}"))


@dataclass(frozen=True, slots=True)
class KnownException:
    """A mistake that shows in exceptions: its id, its page, and the ways in which it shows, the likeliest first.

    `while_running`: it is no explanation of what a program does after Ctrl+C.
    """

    id: str
    page: str
    ways: tuple[Way, ...]
    slip: bool = False
    name: str = ""
    while_running: bool = False
