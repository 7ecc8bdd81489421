"""An entry of the table of known exceptions: what an exception means in a node, and the step that fixes it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

WORD = re.compile(r"\{([a-z]\w*)\}")
"""A word in braces stands for what the exception, or the learner's own line, has in its place."""


@dataclass(frozen=True, slots=True)
class Replace:
    """What the learner's line becomes: `pattern` in it, replaced by `by`. Both may contain words in braces."""

    pattern: str
    by: str


@dataclass(frozen=True, slots=True)
class Example:
    """A case that an entry is for: what was raised, the learner's line and file, and the step that must come out."""

    raised: str
    step: str
    line: str = ""
    source: str = ""
    function: str = "callback"
    at: str = ""


@dataclass(frozen=True, slots=True)
class KnownException:
    """One entry. All of its patterns must be found (`type` as a whole); an empty one asks for nothing.

    `type` is about the last part of the exception's name, `text` about its message, `line` about the learner's own
    line, `source` and `without` about their whole file, which must have the one and must not have the other;
    `through` is found in "function: line" of one of the learner's lines on the way there, `at` in "path, function" of
    the frame that raised. `source`, `without` and `replace` may use the groups of `text` and `line`.
    `look_up` names a table of words, by whose key that is the group `name` (or, unless `exact`, is nearest to it) the
    word `found` is given. `edits` are what `step` says as edits of the file, or several ways to do it: the first that
    leaves the file sound is given, `step` where none does. `of_source`: it is the line that `source` has found, in its
    group `there` if it has one, that is shown and replaced, where the exception comes from a call that rclpy makes.
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
        """The words in braces that its texts ask for."""
        return frozenset(WORD.findall(f"{self.says} {self.step}"))
