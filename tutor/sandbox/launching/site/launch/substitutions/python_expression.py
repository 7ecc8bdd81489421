"""The value of a Python expression."""

from __future__ import annotations

import importlib
from collections.abc import Iterable
from typing import Any

from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities.ensure_argument_type_impl import ensure_argument_type
from ..utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from ..utilities.perform_substitutions_impl import perform_substitutions


class PythonExpression(Substitution):
    """The text of what the expression evaluates to; it knows the modules named, and what `math` holds."""

    def __init__(self, expression: SomeSubstitutionsType, python_modules: SomeSubstitutionsType = ("math",)) -> None:
        ensure_argument_type(expression, (str, Substitution, Iterable), "expression", "PythonExpression")
        ensure_argument_type(python_modules, (str, Substitution, Iterable), "python_modules", "PythonExpression")
        self._expression = normalize_to_list_of_substitutions(expression)
        self._modules = normalize_to_list_of_substitutions(python_modules)

    @property
    def expression(self) -> list[Substitution]:
        return self._expression

    @property
    def python_modules(self) -> list[Substitution]:
        return self._modules

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
        # The launch file is the learner's own code: its expressions may do what it may do.
        return str(eval(perform_substitutions(context, self._expression), {}, names))
