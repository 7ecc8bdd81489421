"""What `ros2 pkg create` writes, by build type."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from tutor.bundled_ros.ros2.pkg.creation import ament_cmake, cpp, manifest, plain_cmake, python
from tutor.bundled_ros.ros2.pkg.creation.new_package import Entry, File, Folder, NewPackage, Note

__all__ = ["BUILD_TYPES", "Entry", "File", "Folder", "NewPackage", "Note", "contents"]

_FILES: dict[str, Callable[[NewPackage], Iterator[Entry]]] = {
    "cmake": plain_cmake.files,
    "ament_cmake": ament_cmake.files,
    "ament_python": python.files,
}

BUILD_TYPES = tuple(_FILES)


def contents(package: NewPackage) -> Iterator[Entry]:
    """Yield the package's folders and files in the order in which they are made. LICENSE is not among them."""
    yield Folder("")
    yield File("package.xml", manifest.text(package))
    if package.build_type == "ament_python":
        yield Note("creating source folder")
        yield Folder(package.name)
    else:
        yield Note("creating source and include folder")
        yield Folder("src")
        yield Folder(f"include/{package.name}")
    yield from _FILES[package.build_type](package)
    if package.build_type != "ament_python":
        yield from cpp.files(package)
