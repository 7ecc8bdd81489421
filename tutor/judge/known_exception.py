"""An entry of the table of known exceptions: what an exception means in a node, and the step that fixes it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

WORD = re.compile(r"\{([a-z]\w*)\}")
"""A placeholder in braces, filled in from the exception or from the learner's own line."""

type Words = Mapping[str, str]
"""The values of an entry's placeholders, by their names."""


@dataclass(frozen=True, slots=True)
class Replace:
    """A fix for the learner's line: `pattern` is replaced by `by`. Both may contain placeholders in braces."""

    pattern: str
    by: str


@dataclass(frozen=True, slots=True)
class Example:
    """A case that an entry must match: the exception raised, the learner's line and file, and the expected step."""

    raised: str
    step: str
    line: str = ""
    source: str = ""
    function: str = "callback"
    at: str = ""


@dataclass(frozen=True, slots=True)
class KnownException:
    """One entry. It applies if all of its patterns (regular expressions) match; an empty pattern always does.

    - `type` must match the last part of the exception's name in full; the other patterns are searched for.
    - `text` is searched for in the message, `line` in the learner's own line.
    - `source` must be found in the learner's whole file, and `without` must not.
    - `through` is searched for in "function: line" of each of the learner's frames in the traceback, `at` in "path,
      function" of the frame that raised.
    - `source`, `without` and `replace` may use the groups of `text` and `line`.
    - `look_up` names a table of words. The entry whose key equals the group `name` (or, unless `exact`, comes closest
      to it) becomes the placeholder `found`.
    - `edits` express `step` as edits of the file, possibly in several alternatives: the first that leaves the file
      sound is shown, and `step` itself if none does.
    - `of_source`: show and replace the line that `source` matched (at its group `there`, if it has one). For
      exceptions from a call that rclpy makes.
    """

    type: str
    says: str
    step: str
    cause: str = ""
    text: str = ""
    line: str = ""
    source: str = ""
    without: str = ""
    through: str = ""
    at: str = ""
    replace: Replace | None = None
    edits: tuple[tuple[Mapping[str, str | list[str]], ...], ...] = ()
    look_up: str = ""
    exact: bool = True
    of_source: bool = False
    examples: tuple[Example, ...] = ()
    words: Mapping[str, str] = field(default_factory=dict)

    @property
    def placeholders(self) -> frozenset[str]:
        """The names of all placeholders in `says` and `step`."""
        return frozenset(WORD.findall(f"{self.says} {self.step}"))
