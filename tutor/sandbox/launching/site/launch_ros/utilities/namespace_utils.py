"""Namespaces in namespaces."""

from __future__ import annotations


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
