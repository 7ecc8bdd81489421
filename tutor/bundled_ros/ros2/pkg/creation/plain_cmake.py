"""The CMake files of a package that needs no ament."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.bundled_ros.ros2.pkg.creation.ament_cmake import (
    EXPORT_SYMBOLS,
    FEATURES,
    NO_DEPENDENCIES,
    WARNINGS,
    find_packages,
)
from tutor.bundled_ros.ros2.pkg.creation.new_package import Entry, File, NewPackage

_VERSION = """\
set({name}_MAJOR_VERSION 0)
set({name}_MINOR_VERSION 0)
set({name}_PATCH_VERSION 0)
set({name}_VERSION
  ${{{name}_MAJOR_VERSION}}.${{{name}_MINOR_VERSION}}.${{{name}_PATCH_VERSION}})
"""

_INSTALL_LIBRARY = """\
install(
  TARGETS {library}
  EXPORT export_{name}
  ARCHIVE DESTINATION lib
  LIBRARY DESTINATION lib
  RUNTIME DESTINATION bin)
"""

_INSTALL_NODE = """\

install(
  TARGETS {node}
  EXPORT export_{name}
  DESTINATION lib/${{PROJECT_NAME}})
"""

_EXPORT = """\
export(EXPORT export_{name}
  FILE "${{PROJECT_BINARY_DIR}}/export_{name}.cmake")

# Create the {name}Config.cmake
set(CONF_INCLUDE_DIRS "${{CMAKE_INSTALL_PREFIX}}/include")
configure_file({name}Config.cmake.in
  "${{PROJECT_BINARY_DIR}}/${{CMAKE_FILES_DIRECTORY}}/{name}Config.cmake" @ONLY)

# Create the {name}ConfigVersion.cmake
configure_file({name}ConfigVersion.cmake.in
  "${{PROJECT_BINARY_DIR}}/{name}ConfigVersion.cmake" @ONLY)

install(FILES
  "${{PROJECT_BINARY_DIR}}/${{CMAKE_FILES_DIRECTORY}}/{name}Config.cmake"
  "${{PROJECT_BINARY_DIR}}/{name}ConfigVersion.cmake"
  DESTINATION "share/${{PROJECT_NAME}}/cmake" COMPONENT dev)
install(EXPORT export_{name}
  DESTINATION "share/${{PROJECT_NAME}}/cmake"
  FILE export_{name}.cmake
  COMPONENT dev)
"""

_CONFIG = """\
# - Config file for the {name} package
# It defines the following variables
#  {name}_INCLUDE_DIRS - include directories for FooBar
#  {name}_LIBRARIES    - libraries to link against
#  {name}_EXECUTABLE   - the bar executable

set({name}_INCLUDE_DIRS "@CONF_INCLUDE_DIRS@")

# Our library dependencies (contains definitions for IMPORTED targets)
include("${{{name}_DIR}}/export_{name}.cmake")

# These are IMPORTED targets created by {name}Targets.cmake
"""

_CONFIG_VERSION = """\
set(PACKAGE_VERSION "@{name}_VERSION@")

# Check whether the requested PACKAGE_FIND_VERSION is compatible
if("${{PACKAGE_VERSION}}" VERSION_LESS "${{PACKAGE_FIND_VERSION}}")
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
else()
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
  if ("${{PACKAGE_VERSION}}" VERSION_EQUAL "${{PACKAGE_FIND_VERSION}}")
    set(PACKAGE_VERSION_EXACT TRUE)
  endif()
endif()
"""


def files(package: NewPackage) -> Iterator[Entry]:
    """Yield CMakeLists.txt and the templates of the files by which CMake finds the installed package."""
    name = package.name
    yield File("CMakeLists.txt", "".join(_sections(package)))
    yield File(f"{name}Config.cmake.in", "".join(_config(package)))
    yield File(f"{name}ConfigVersion.cmake.in", _CONFIG_VERSION.format(name=name))


def _config(package: NewPackage) -> Iterator[str]:
    name = package.name
    yield _CONFIG.format(name=name)
    yield f"set({name}_LIBRARIES {package.library})\n\n" if package.library else "\n"
    yield f"set({name}_EXECUTABLE {package.node})\n\n" if package.node else "\n"


def _sections(package: NewPackage) -> Iterator[str]:
    name = package.name
    yield f"cmake_minimum_required(VERSION 3.8)\nproject({name})\n\n{_VERSION.format(name=name)}\n{WARNINGS}\n"
    if package.dependencies:
        yield f"\n# find dependencies\n{find_packages(package.dependencies)}"
    else:
        yield NO_DEPENDENCIES
    if package.library:
        yield from _library(package)
    if package.node:
        yield from _node(package)
    if targets := [target for target in (package.library, package.node) if target]:
        yield "\n# export targets\n"
        for target in targets:
            yield f"set(export_targets ${{export_targets}};{target})\n"
        yield _EXPORT.format(name=name)


def _library(package: NewPackage) -> Iterator[str]:
    name, library = package.name, package.library
    yield f"\nadd_library({library} SHARED src/{library}.cpp)\n"
    yield f"add_library({name}::{library} ALIAS {library})\n"
    yield FEATURES.format(target=library)
    yield _includes(package, library)
    yield _links(package, library)
    yield EXPORT_SYMBOLS.format(library=library, macro=name.upper(), include="include")
    yield _INSTALL_LIBRARY.format(library=library, name=name)


def _node(package: NewPackage) -> Iterator[str]:
    node = package.node
    yield f"\nadd_executable({node} src/{node}.cpp)\n"
    if package.dependencies:
        yield _includes(package, node)
    if package.library:
        yield f"target_link_libraries({node} {package.library})\n"
    else:
        yield FEATURES.format(target=node)
        yield _links(package, node)
    yield _INSTALL_NODE.format(node=node, name=package.name)


def _includes(package: NewPackage, target: str) -> str:
    folders = "".join(f"  PUBLIC ${{{name}_INCLUDE_DIRS}}\n" for name in package.dependencies)
    return (
        f"target_include_directories({target} PUBLIC\n"
        "  $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>\n"
        f"  $<INSTALL_INTERFACE:include>\n{folders})\n"
    )


def _links(package: NewPackage, target: str) -> str:
    if not package.dependencies:
        return ""
    libraries = "".join(f" ${{{name}_LIBRARIES}}\n" for name in package.dependencies)
    return f"target_link_libraries({target}\n{libraries})\n"
