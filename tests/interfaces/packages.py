"""Interface packages for tests, written into a folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

PACKAGE_XML = """\
<?xml version="1.0"?>
<package format="3">
  <name>{name}</name>
  <version>0.0.0</version>
  <description>test</description>
  <maintainer email="a@example.com">a</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""


def write_package(
    workspace: Path,
    files: Mapping[str, str],
    *,
    name: str = "bell_interfaces",
    dependencies: Sequence[str] = (),
    listed: Sequence[str] | None = None,
) -> Path:
    """Write an interface package into a workspace's `src`; `listed`: the files in CMakeLists.txt (default: all)."""
    folder = workspace / "src" / name
    for file, text in files.items():
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text(text)
    (folder / "package.xml").write_text(PACKAGE_XML.format(name=name))
    found = "\n".join(f"find_package({package} REQUIRED)" for package in ("rosidl_default_generators", *dependencies))
    names = " ".join(f'"{file}"' for file in (files if listed is None else listed))
    after = f" DEPENDENCIES {' '.join(dependencies)}" if dependencies else ""
    (folder / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.8)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n{found}\n"
        f"rosidl_generate_interfaces(${{PROJECT_NAME}} {names}{after})\nament_package()\n"
    )
    return folder
