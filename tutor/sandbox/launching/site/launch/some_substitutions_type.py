"""What may stand wherever a substitution may stand."""

import collections.abc
from collections.abc import Iterable

from .substitution import Substitution

SomeSubstitutionsType = str | Substitution | Iterable[str | Substitution]
"""A text, a substitution, or several of them to be joined."""

SomeSubstitutionsType_types_tuple = (str, Substitution, collections.abc.Iterable)
