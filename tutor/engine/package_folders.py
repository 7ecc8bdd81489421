"""The folders that belong to a learner's file."""

from __future__ import annotations

from pathlib import Path


def package_folder(path: Path) -> Path:
    """Return the folder of the file's ROS package, else the parent of its Python package, else its own folder."""
    candidates = [path.parent, *path.parents[1:3]]
    return next(
        (folder for folder in candidates if (folder / "package.xml").is_file()), package_root(path) or path.parent
    )


def package_root(path: Path) -> Path | None:
    """Return the folder from which the file's package can be imported; None if the file is not in a package."""
    return path.parent.parent if (path.parent / "__init__.py").is_file() else None
