"""What an examination found."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was examined.

    `ok` is True where all is well, False where checks cannot work, and None for a warning: checks work, but there is
    something to know. `hint` says what to do, and is empty where there is nothing to do.
    """

    name: str
    ok: bool | None
    text: str
    hint: str = ""
