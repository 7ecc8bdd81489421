"""package.xml of a new package."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator

from tutor.bundled_ros.ros2.pkg.creation.new_package import NewPackage

_PYTHON_TEST_TOOLS = ("ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest")
_CMAKE_TEST_TOOLS = ("ament_lint_auto", "ament_lint_common")


def text(package: NewPackage) -> str:
    """Return the manifest."""
    return "\n".join(_lines(package)) + "\n"


def _lines(package: NewPackage) -> Iterator[str]:
    schema = f"http://download.ros.org/schema/package_format{package.format}.xsd"
    maintainer = f'<maintainer email="{_escape_attribute(package.email)}">{_escape(package.maintainer)}</maintainer>'
    yield '<?xml version="1.0"?>'
    yield f'<?xml-model href="{schema}" schematypens="http://www.w3.org/2001/XMLSchema"?>'
    yield f'<package format="{package.format}">'
    yield f"  <name>{package.name}</name>"
    yield f"  <version>{package.version}</version>"
    yield f"  <description>{_escape(package.description)}</description>"
    yield f"  {maintainer}"
    yield f"  <license>{_escape(package.license)}</license>"
    yield ""
    yield from _dependencies("buildtool_depend", _build_tools(package))
    yield from _dependencies("depend", package.dependencies)
    yield from _dependencies("test_depend", _test_tools(package))
    yield "  <export>"
    yield f"    <build_type>{package.build_type}</build_type>"
    yield "  </export>"
    yield "</package>"


def _dependencies(tag: str, names: Iterable[str]) -> Iterator[str]:
    lines = [f"  <{tag}>{name}</{tag}>" for name in names]
    yield from [*lines, ""] if lines else []


def _build_tools(package: NewPackage) -> tuple[str, ...]:
    if package.build_type != "ament_cmake":
        return ()
    return ("ament_cmake_ros",) if package.library else ("ament_cmake",)


def _test_tools(package: NewPackage) -> tuple[str, ...]:
    return {"ament_python": _PYTHON_TEST_TOOLS, "ament_cmake": _CMAKE_TEST_TOOLS}.get(package.build_type, ())


def _escape(text: str, *, within: str = "<a>{}</a>") -> str:
    """Return the text as it is where XML can hold it so, as the real `ros2` does; else with its signs escaped."""
    try:
        ET.fromstring(within.format(text))
    except ET.ParseError:
        text = re.sub(r"&(?!#?\w+;)", "&amp;", text).replace("<", "&lt;").replace('"', "&quot;")
    return text


def _escape_attribute(text: str) -> str:
    return _escape(text, within='<a b="{}"/>')
