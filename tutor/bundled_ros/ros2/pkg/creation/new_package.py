"""A package to be created, and the entries of its folder."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class NewPackage:
    """What is known of a package before it exists. `node` and `library` are empty if there is to be none."""

    name: str
    build_type: str
    format: int
    description: str
    license: str
    maintainer: str
    email: str
    dependencies: tuple[str, ...]
    node: str
    library: str
    version: str = "0.0.0"


@dataclass(frozen=True, slots=True)
class Folder:
    """A folder to make; `path` is relative to the package's own, for which it is empty."""

    path: str


@dataclass(frozen=True, slots=True)
class File:
    """A file to write; `path` is relative to the package's folder."""

    path: str
    text: str


@dataclass(frozen=True, slots=True)
class Note:
    """A line that is only printed."""

    text: str


Entry = Folder | File | Note
