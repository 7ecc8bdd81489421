"""`ros2 param`."""

from __future__ import annotations

VERBS = {
    "delete": "Delete a parameter",
    "describe": "Show what a node says about its parameters",
    "dump": "Show all parameters of a node as a YAML file",
    "get": "Show a parameter's value",
    "list": "List the parameters",
    "load": "Set the parameters of a node from a YAML file",
    "set": "Set a parameter",
}
