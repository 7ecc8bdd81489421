"""One-line messages for YAML that a user has typed."""

from __future__ import annotations


def yaml_problem(error: Exception) -> str:
    """Return the problem that a yaml.YAMLError reports, in one line and without its position."""
    return " ".join(str(getattr(error, "problem", None) or error).split())
