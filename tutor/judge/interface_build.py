"""What became of an interface package beside a submission's files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

Definition = tuple[str, ...]
"""The fields of a type, each as in "float64 value", with "---" between the parts of a service or an action."""


@dataclass(frozen=True, slots=True)
class InterfaceBuild:
    """One interface package: built, with these types, or not, for these reasons.

    `types`: the definition of each built type, by a name such as "msg/Reading". `problems`: one sentence each, which
    begins with the place; empty if it is built. `unlisted`: files that its CMakeLists.txt does not name.
    """

    package: str
    types: Mapping[str, Definition] = field(default_factory=dict)
    problems: tuple[str, ...] = ()
    unlisted: tuple[str, ...] = ()
