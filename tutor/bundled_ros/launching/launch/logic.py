"""Substitutions that compute: truth values, comparisons, Python expressions."""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable, Iterable
from typing import Any

from tutor.bundled_ros.launching.launch.base import LaunchContext, SomeSubstitutionsType, Substitution
from tutor.bundled_ros.launching.launch.text import SUBSTITUTIONS
from tutor.bundled_ros.launching.launch.values import (
    SubstitutionFailure,
    TextSubstitution,
    ensure_argument_type,
    is_substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    perform_typed_substitution,
)


class _Boolean(Substitution):
    """Combines truth values into `true` or `false`, without short-circuiting."""

    _combine: Callable[[Iterable[bool]], bool]

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self._args = [normalize_to_list_of_substitutions(arg) for arg in args]

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
    """Whether the value is false."""

    _combine = staticmethod(lambda values: not any(values))

    def __init__(self, value: SomeSubstitutionsType) -> None:
        super().__init__(value)


class _Pair(_Boolean):
    """Two truth values."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)


class AndSubstitution(_Pair):
    """Whether both are true."""

    _combine = staticmethod(all)


class OrSubstitution(_Pair):
    """Whether at least one of the two is true."""

    _combine = staticmethod(any)


TRUE, FALSE = ("true", "1"), ("false", "0")


class EqualsSubstitution(Substitution):
    """`true` if both are the same truth value, the same number or the same text."""

    def __init__(self, left: Any, right: Any) -> None:
        self._left = normalize_to_list_of_substitutions(_text(left))
        self._right = normalize_to_list_of_substitutions(_text(right))

    def describe(self) -> str:
        return f"{type(self).__name__}({self._left} {self._right})"

    def perform(self, context: LaunchContext) -> str:
        return str(self._equal(context)).lower()

    def _equal(self, context: LaunchContext) -> bool:
        left, right = perform_substitutions(context, self._left), perform_substitutions(context, self._right)
        truths = [_parse_bool(left), _parse_bool(right)]
        if None not in truths:
            return truths[0] == truths[1]
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return left == right


def _text(value: Any) -> Any:
    if is_substitution(value):
        return value
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _parse_bool(text: str) -> bool | None:
    return True if text.lower() in TRUE else False if text.lower() in FALSE else None


class NotEqualsSubstitution(EqualsSubstitution):
    """`true` if the two are not equal in the sense of EqualsSubstitution."""

    def perform(self, context: LaunchContext) -> str:
        return str(not self._equal(context)).lower()


class IfElseSubstitution(Substitution):
    """The first text if the condition is true, else the second."""

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        if if_value == else_value == "":
            raise RuntimeError("One of if_value and else_value must be specified")
        self._condition = normalize_to_list_of_substitutions(condition)
        self._if = normalize_to_list_of_substitutions(if_value)
        self._else = normalize_to_list_of_substitutions(else_value)

    def describe(self) -> str:
        return f"IfElseSubstitution({self._condition}, {self._if}, {self._else})"

    def perform(self, context: LaunchContext) -> str:
        try:
            chosen = self._if if perform_typed_substitution(context, self._condition, bool) else self._else
        except (TypeError, ValueError) as error:
            raise SubstitutionFailure(error) from error
        return perform_substitutions(context, chosen)


class PythonExpression(Substitution):
    """The result of a Python expression as a text. It can use the given modules, and the names in `math` directly."""

    def __init__(self, expression: SomeSubstitutionsType, python_modules: SomeSubstitutionsType = ("math",)) -> None:
        ensure_argument_type(expression, (str, Substitution, Iterable), "expression", "PythonExpression")
        ensure_argument_type(python_modules, (str, Substitution, Iterable), "python_modules", "PythonExpression")
        self._expression = normalize_to_list_of_substitutions(expression)
        self._modules = normalize_to_list_of_substitutions(python_modules)

    def describe(self) -> str:
        expression = " + ".join(part.describe() for part in self._expression)
        return f"PythonExpr({expression}, [{', '.join(part.describe() for part in self._modules)}])"

    def perform(self, context: LaunchContext) -> str:
        names: dict[str, Any] = {}
        for item in self._modules:
            module = importlib.import_module(context.perform_substitution(item))
            if module.__name__ == "math":
                names.update(vars(module))
            names[module.__name__] = module
        # The launch file is the learner's own code, so its expressions may do whatever it may do.
        return str(eval(perform_substitutions(context, self._expression), {}, names))


def _eval(expression: list[Substitution], modules: list[Substitution] | None = None) -> Substitution:
    if modules is None:
        return PythonExpression(expression)
    named = "".join(part.text for part in modules if isinstance(part, TextSubstitution))
    return PythonExpression(expression, [name.strip() for name in named.split(",") if name.strip()])


SUBSTITUTIONS |= {
    "all": (0, 99, AllSubstitution),
    "and": (2, 2, AndSubstitution),
    "any": (0, 99, AnySubstitution),
    "equals": (2, 2, EqualsSubstitution),
    "eval": (1, 2, _eval),
    "if": (2, 3, IfElseSubstitution),
    "not": (1, 1, NotSubstitution),
    "not-equals": (2, 2, NotEqualsSubstitution),
    "or": (2, 2, OrSubstitution),
}
