"""`ros2 pkg`."""

from __future__ import annotations

VERBS = {
    "create": "Make a new package",
    "executables": "List the programs of a package, or of all",
    "list": "List the packages",
    "prefix": "Show where a package is",
    "xml": "Show a package's package.xml",
}
