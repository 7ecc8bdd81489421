"""Names that ROS takes."""

from __future__ import annotations

import re


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
