"""What is wrong with a YAML text that a user has typed."""

from __future__ import annotations


def yaml_problem(error: Exception) -> str:
    """What a yaml.YAMLError says, in one line and without the place."""
    return " ".join(str(getattr(error, "problem", None) or error).split())
