"""Small helpers for the actions: names that ROS takes, namespaces, remappings, parameters."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from launch._entities import SomeSubstitutionsType, Substitution
from launch.utilities import ensure_argument_type, normalize_to_list_of_substitutions

from .parameter_descriptions import (
    evaluate_parameter_dict,
    evaluate_parameters,
    normalize_parameter_dict,
    normalize_parameters,
)

__all__ = [
    "evaluate_parameter_dict",
    "evaluate_parameters",
    "is_namespace_absolute",
    "is_root_namespace",
    "make_namespace_absolute",
    "normalize_parameter_dict",
    "normalize_parameters",
    "normalize_remap_rule",
    "normalize_remap_rules",
    "prefix_namespace",
    "validate_namespace",
    "validate_node_name",
]


class InvalidNodeNameException(Exception):  # noqa: N818, RUF100 - rclpy's name
    """A name that no node can have."""


class InvalidNamespaceException(Exception):  # noqa: N818, RUF100 - rclpy's name
    """A name that no namespace can have."""


def validate_node_name(name: str) -> None:
    """InvalidNodeNameException where ROS would not take it."""
    fault = "node name must not be empty" if not name else _fault(name, "node name", r"[A-Za-z0-9_]")
    if fault is not None:
        raise InvalidNodeNameException(f"Invalid node name: {fault}")


def validate_namespace(namespace: str) -> None:
    """InvalidNamespaceException where ROS would not take it."""
    fault = _fault_of_namespace(namespace)
    if fault is not None:
        raise InvalidNamespaceException(f"Invalid namespace: {fault}")


def _fault_of_namespace(namespace: str) -> str | None:
    if not namespace:
        return "namespace must not be empty"
    if not namespace.startswith("/"):
        return f"namespace must be absolute, it must lead with a '/': '{namespace}'"
    if namespace == "/":
        return None
    if namespace.endswith("/"):
        return f"namespace must not end with a '/', unless only a '/': '{namespace}'"
    if "//" in namespace:
        return f"namespace must not contain repeated '/': '{namespace}'"
    for token in namespace.split("/")[1:]:
        fault = _fault(token, "namespace", r"[A-Za-z0-9_]", whole=namespace)
        if fault is not None:
            return fault
    return None


def _fault(token: str, kind: str, allowed: str, whole: str | None = None) -> str | None:
    shown = token if whole is None else whole
    if not re.fullmatch(f"{allowed}*", token):
        slash = " or '/'" if kind == "namespace" else ""
        return f"{kind} must not contain characters other than alphanumerics, '_'{slash}: '{shown}'"
    if token[:1].isdigit():
        what = (
            "node name must not start with a number"
            if kind == "node name"
            else "namespace must not have a token that starts with a number"
        )
        return f"{what}: '{shown}'"
    return None


def is_root_namespace(ns: str) -> bool:
    """Whether it is the outermost one."""
    return ns == "/"


def is_namespace_absolute(ns: str) -> bool:
    """Whether it does not care what it is in."""
    return ns.startswith("/")


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """`ns` inside `base_ns`; None where there is neither."""
    if ns is None:
        inner = base_ns
    elif not base_ns or is_namespace_absolute(ns):
        inner = ns
    else:
        inner = f"{'' if is_root_namespace(base_ns) else base_ns}/{ns}"
    return inner if inner is None or is_root_namespace(inner) else inner.rstrip("/")


def make_namespace_absolute(ns: str | None) -> str | None:
    """With the slash in front; None stays None."""
    return ns if ns is None or is_namespace_absolute(ns) else f"/{ns}"


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
