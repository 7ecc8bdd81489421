"""Whatever may stand for a substitution, as a list of substitutions."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from ..substitution import Substitution


def normalize_to_list_of_substitutions(subs: Any) -> list[Substitution]:
    """A text, a path, a substitution, or an iterable of them, as a list; TypeError for anything else."""
    if isinstance(subs, str | Path | Substitution):
        return [_substitution(subs)]
    return [_substitution(item) for item in subs]


def _substitution(item: object) -> Substitution:
    from ..substitutions.text_substitution import TextSubstitution

    if isinstance(item, Substitution):
        return item
    if isinstance(item, str | Path):
        return TextSubstitution(text=os.fspath(item))
    raise TypeError(
        f"Failed to normalize given item of type '{type(item)}', when only 'str', 'pathlib.Path' or "
        "'launch.Substitution' were expected."
    )
