"""`ros2 param`."""

from __future__ import annotations

from tutor.bundled_ros.ros2.parsing import Group, Verbs

_VERBS: Verbs = {
    "delete": ("Delete a parameter", "param.changing"),
    "describe": ("Show what a node says about its parameters", "param.showing"),
    "dump": ("Show all parameters of a node as a YAML file", "param.showing"),
    "get": ("Show a parameter's value", "param.showing"),
    "list": ("List the parameters", "param.showing"),
    "load": ("Set the parameters of a node from a YAML file", "param.changing"),
    "set": ("Set a parameter", "param.changing"),
}
GRAMMAR = {"param": Group(_VERBS)}
