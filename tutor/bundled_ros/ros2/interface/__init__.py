"""`ros2 interface`."""

from __future__ import annotations

VERBS = {
    "list": "List all message, service and action types",
    "package": "List the types of a package",
    "packages": "List the packages that have types",
    "proto": "Show an example of a type's value, as YAML",
    "show": "Show how a type is defined",
}
