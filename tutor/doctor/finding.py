"""The result of one examination."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """The result of one examination.

    `ok` is True if all is well, False if checks cannot work, and None for a warning: checks work, but with a
    limitation. `hint` says what to do; empty if there is nothing to do.
    """

    name: str
    ok: bool | None
    text: str
    hint: str = ""
