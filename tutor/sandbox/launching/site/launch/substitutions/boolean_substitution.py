"""Not, and, or, any, all of truth values."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from ..utilities.type_utils import perform_typed_substitution
from .substitution_failure import SubstitutionFailure


class _Boolean(Substitution):
    """Combines truth values into `true` or `false`; each is evaluated."""

    _combine: Callable[[Iterable[bool]], bool]

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self._args = [normalize_to_list_of_substitutions(arg) for arg in args]

    @property
    def args(self) -> list[list[Substitution]]:
        return self._args

    def describe(self) -> str:
        return f"{type(self).__name__}({' '.join(str(arg) for arg in self._args)})"

    def perform(self, context: LaunchContext) -> str:
        try:
            values = [bool(perform_typed_substitution(context, arg, bool)) for arg in self._args]
        except (TypeError, ValueError) as error:
            raise SubstitutionFailure(error) from error
        return str(type(self)._combine(values)).lower()


class AnySubstitution(_Boolean):
    """Whether at least one is true."""

    _combine = staticmethod(any)


class AllSubstitution(_Boolean):
    """Whether all are true."""

    _combine = staticmethod(all)


class NotSubstitution(_Boolean):
    """Whether it is false."""

    _combine = staticmethod(lambda values: not any(values))

    def __init__(self, value: SomeSubstitutionsType) -> None:
        super().__init__(value)

    @property
    def value(self) -> list[Substitution]:
        return self._args[0]


class _Pair(_Boolean):
    """Two truth values."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)

    @property
    def left(self) -> list[Substitution]:
        return self._args[0]

    @property
    def right(self) -> list[Substitution]:
        return self._args[1]


class AndSubstitution(_Pair):
    """Whether both are true."""

    _combine = staticmethod(all)


class OrSubstitution(_Pair):
    """Whether at least one of the two is true."""

    _combine = staticmethod(any)
