"""CMakeLists.txt of an ament_cmake package."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.bundled_ros.ros2.pkg.creation.new_package import Entry, File, NewPackage

WARNINGS = """\
if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wall -Wextra -Wpedantic)
endif()
"""

NO_DEPENDENCIES = """\
# uncomment the following section in order to fill in
# further dependencies manually.
# find_package(<dependency> REQUIRED)
"""

FEATURES = "target_compile_features({target} PUBLIC c_std_99 cxx_std_17)  # Require C99 and C++17\n"

EXPORT_SYMBOLS = """\

# Causes the visibility macros to use dllexport rather than dllimport,
# which is appropriate when building the dll but not consuming it.
target_compile_definitions({library} PRIVATE "{macro}_BUILDING_LIBRARY")

install(
  DIRECTORY include/
  DESTINATION {include}
)
"""

_INCLUDES = """\
target_include_directories({target} PUBLIC
  $<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}/include>
  $<INSTALL_INTERFACE:include/${{PROJECT_NAME}}>)
"""

_INSTALL_LIBRARY = """\
install(
  TARGETS {library}
  EXPORT export_${{PROJECT_NAME}}
  ARCHIVE DESTINATION lib
  LIBRARY DESTINATION lib
  RUNTIME DESTINATION bin
)
"""

_LINTERS = """\

if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  # the following line skips the linter which checks for copyrights
  # comment the line when a copyright and license is added to all source files
  set(ament_cmake_copyright_FOUND TRUE)
  # the following line skips cpplint (only works in a git repo)
  # comment the line when this package is in a git repo and when
  # a copyright and license is added to all source files
  set(ament_cmake_cpplint_FOUND TRUE)
  ament_lint_auto_find_test_dependencies()
endif()
"""

_EXPORT_LIBRARY = """\

ament_export_include_directories(
  "include/${{PROJECT_NAME}}"
)
ament_export_libraries(
  {library}
)
ament_export_targets(
  export_${{PROJECT_NAME}}
)
"""


def files(package: NewPackage) -> Iterator[Entry]:
    """Yield CMakeLists.txt."""
    yield File("CMakeLists.txt", "".join(_sections(package)))


def find_packages(names: tuple[str, ...]) -> str:
    """Return the lines that find these packages."""
    return "".join(f"find_package({name} REQUIRED)\n" for name in names)


def _sections(package: NewPackage) -> Iterator[str]:
    tools = ("ament_cmake", "ament_cmake_ros") if package.library else ("ament_cmake",)
    yield f"cmake_minimum_required(VERSION 3.8)\nproject({package.name})\n\n{WARNINGS}\n"
    yield f"# find dependencies\n{find_packages(tools)}"
    yield find_packages(package.dependencies) or NO_DEPENDENCIES
    if package.library:
        yield from _library(package)
    if package.node:
        yield from _node(package)
    yield _LINTERS
    if package.library:
        yield _EXPORT_LIBRARY.format(library=package.library)
    yield "\nament_package()\n"


def _library(package: NewPackage) -> Iterator[str]:
    library = package.library
    yield f"\nadd_library({library} src/{library}.cpp)\n"
    yield f"add_library({package.name}::{library} ALIAS {library})\n"
    yield FEATURES.format(target=library)
    yield _INCLUDES.format(target=library)
    yield _uses(package, library)
    yield EXPORT_SYMBOLS.format(library=library, macro=package.name.upper(), include="include/${PROJECT_NAME}")
    yield _INSTALL_LIBRARY.format(library=library)


def _node(package: NewPackage) -> Iterator[str]:
    node = package.node
    yield f"\nadd_executable({node} src/{node}.cpp)\n"
    yield _INCLUDES.format(target=node)
    if package.library:
        yield f"target_link_libraries({node} {package.library})\n"
    else:
        yield FEATURES.format(target=node)
        yield _uses(package, node)
    yield f"\ninstall(TARGETS {node}\n  DESTINATION lib/${{PROJECT_NAME}})\n"


def _uses(package: NewPackage, target: str) -> str:
    if not package.dependencies:
        return ""
    names = "".join(f'  "{name}"\n' for name in package.dependencies)
    return f"ament_target_dependencies(\n  {target}\n{names})\n"
