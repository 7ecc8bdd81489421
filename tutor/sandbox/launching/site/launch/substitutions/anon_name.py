"""A name that no other launch uses."""

from __future__ import annotations

import os
import random
import re
import socket

from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from ..utilities.perform_substitutions_impl import perform_substitutions


class AnonName(Substitution):
    """The name with a unique ending; the same one wherever a launch asks for the same name."""

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        return self._name

    def describe(self) -> str:
        return f"AnonName({' + '.join(item.describe() for item in self._name)})"

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self._name)
        unique = f"{name}_{socket.gethostname()}_{os.getpid()}_{random.getrandbits(63)}"
        found: str = context.launch_configurations.setdefault(f"anon{name}", re.sub(r"[.:-]", "_", unique))
        return found
