"""What may stand wherever a substitution may stand."""

import collections.abc
from collections.abc import Iterable
from pathlib import Path

from .substitution import Substitution

SomeSubstitutionsType = str | Path | Substitution | Iterable[str | Path | Substitution]
"""A text, a path, a substitution, or several of them to be joined."""

SomeSubstitutionsType_types_tuple = (str, Path, Substitution, collections.abc.Iterable)
