"""Small helpers for the actions: validation of names, namespaces, remappings and parameters."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from tutor.bundled_ros.launching.launch.base import SomeSubstitutionsType, Substitution
from tutor.bundled_ros.launching.launch.values import ensure_argument_type, normalize_to_list_of_substitutions


class InvalidNodeNameException(Exception):  # noqa: N818, RUF100 - rclpy's name
    """The name is not a valid node name."""

    __module__ = "launch_ros.utilities"


class InvalidNamespaceException(Exception):  # noqa: N818, RUF100 - rclpy's name
    """The name is not a valid namespace."""

    __module__ = "launch_ros.utilities"


def validate_node_name(name: str) -> None:
    """Raise InvalidNodeNameException if ROS would reject the name."""
    fault = "node name must not be empty" if not name else _find_fault(name, "node name", r"[A-Za-z0-9_]")
    if fault is not None:
        raise InvalidNodeNameException(f"Invalid node name: {fault}")


def validate_namespace(namespace: str) -> None:
    """Raise InvalidNamespaceException if ROS would reject the namespace."""
    fault = _find_namespace_fault(namespace)
    if fault is not None:
        raise InvalidNamespaceException(f"Invalid namespace: {fault}")


def _find_namespace_fault(namespace: str) -> str | None:
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
        fault = _find_fault(token, "namespace", r"[A-Za-z0-9_]", whole=namespace)
        if fault is not None:
            return fault
    return None


def _find_fault(token: str, kind: str, allowed: str, whole: str | None = None) -> str | None:
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
    """Return whether a namespace is the root namespace."""
    return ns == "/"


def is_namespace_absolute(ns: str) -> bool:
    """Return whether a namespace starts with a slash, so that no outer namespace is prepended."""
    return ns.startswith("/")


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """Return `ns` inside `base_ns`; None if neither is given."""
    if ns is None:
        joined = base_ns
    elif not base_ns or is_namespace_absolute(ns):
        joined = ns
    else:
        joined = f"{'' if is_root_namespace(base_ns) else base_ns}/{ns}"
    return joined if joined is None or is_root_namespace(joined) else joined.rstrip("/")


def make_namespace_absolute(ns: str | None) -> str | None:
    """Add a leading slash if it is missing; None stays None."""
    return ns if ns is None or is_namespace_absolute(ns) else f"/{ns}"


SomeRemapRule = tuple[SomeSubstitutionsType, SomeSubstitutionsType]
RemapRule = tuple[tuple[Substitution, ...], tuple[Substitution, ...]]


def normalize_remap_rule(remap_rule: SomeRemapRule) -> RemapRule:
    """Normalize a remapping, a pair of the original and the new name. Raises TypeError for anything else."""
    ensure_argument_type(remap_rule, tuple, "remap_rule")
    if len(remap_rule) != 2:
        raise TypeError(f"remap_rule must be a tuple of length 2, got length {len(remap_rule)}")
    src, dst = remap_rule
    return tuple(normalize_to_list_of_substitutions(src)), tuple(normalize_to_list_of_substitutions(dst))


def normalize_remap_rules(remap_rules: Iterable[SomeRemapRule]) -> Iterator[RemapRule]:
    """Normalize several remappings."""
    return map(normalize_remap_rule, remap_rules)
