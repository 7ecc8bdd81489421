"""The learners of a class, and how each is named in the folder of results."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

_MAX_ID_BYTES = 100


@dataclass(frozen=True, slots=True)
class Learner:
    """One learner. `id` names the folder in the results: unique in a class, whatever the file system.

    `name` is shown to people. `number` and `email` are what the school's system knows the learner by; empty if unknown.
    `columns`: the learner's row of the roster.
    """

    id: str
    name: str
    number: str = ""
    email: str = ""
    columns: Mapping[str, str] = field(default_factory=dict)


def with_unique_ids(learners: Iterable[Learner]) -> list[Learner]:
    """Return the learners with ids that can name folders, and differ even where upper and lower case do not.

    Of several with the same id, all but the first get their number added to it, or else a count.
    """
    taken: set[str] = set()
    result = []
    for learner in learners:
        unique = safe_name(learner.id)
        if _folded(unique) in taken and learner.number:
            unique = _with_suffix(learner.id, learner.number)
        count = 1
        while _folded(unique) in taken:
            count += 1
            unique = _with_suffix(learner.id, str(count))
        taken.add(_folded(unique))
        result.append(replace(learner, id=unique))
    return result


def _with_suffix(text: str, suffix: str) -> str:
    ending = safe_name(f"-{suffix}", _MAX_ID_BYTES // 4)
    return safe_name(text, _MAX_ID_BYTES - len(ending.encode())) + ending


def safe_name(text: str, max_bytes: int = _MAX_ID_BYTES) -> str:
    """Return a name for a folder: printable, without separators, neither hidden nor empty, of limited length."""
    clean = "".join(
        character if character.isprintable() and character not in '/\\:*?"<>|' else "_" for character in text
    )
    return clean.strip(" .").encode()[:max_bytes].decode(errors="ignore").strip(" .") or "unnamed"


def _folded(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()
