"""Launch files in XML and YAML: read as entities, which are turned into the same actions that Python files make."""

from .load import load_launch_description, suffixes
from .text import parse_substitution

__all__ = ["load_launch_description", "parse_substitution", "suffixes"]
