"""Remappings as they are written, as substitutions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import ensure_argument_type, normalize_to_list_of_substitutions

SomeRemapRule = tuple[SomeSubstitutionsType, SomeSubstitutionsType]
RemapRule = tuple[tuple[Substitution, ...], tuple[Substitution, ...]]


def normalize_remap_rule(remap_rule: SomeRemapRule) -> RemapRule:
    """One remapping: the name in the node, the name instead; TypeError for anything else than a pair."""
    ensure_argument_type(remap_rule, tuple, "remap_rule")
    if len(remap_rule) != 2:
        raise TypeError(f"remap_rule must be a tuple of length 2, got length {len(remap_rule)}")
    src, dst = remap_rule
    return tuple(normalize_to_list_of_substitutions(src)), tuple(normalize_to_list_of_substitutions(dst))


def normalize_remap_rules(remap_rules: Iterable[SomeRemapRule]) -> Iterator[RemapRule]:
    """Several remappings."""
    return map(normalize_remap_rule, remap_rules)
