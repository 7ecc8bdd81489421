"""The C++ sources of a package that CMake builds."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.bundled_ros.ros2.pkg.creation.new_package import Entry, File, NewPackage

_MAIN = """\
#include <cstdio>

int main(int argc, char ** argv)
{{
  (void) argc;
  (void) argv;

  printf("hello world {package} package\\n");
  return 0;
}}
"""

_HEADER = """\
#ifndef {guard}
#define {guard}

#include "{package}/visibility_control.h"

namespace {package}
{{

class {of}
{{
public:
  {of}();

  virtual ~{of}();
}};

}}  // namespace {package}

#endif  // {guard}
"""

_LIBRARY = """\
#include "{package}/{library}.hpp"

namespace {package}
{{

{of}::{of}()
{{
}}

{of}::~{of}()
{{
}}

}}  // namespace {package}
"""

_VISIBILITY = """\
#ifndef {macro}__VISIBILITY_CONTROL_H_
#define {macro}__VISIBILITY_CONTROL_H_

// This logic was borrowed (then namespaced) from the examples on the gcc wiki:
//     https://gcc.gnu.org/wiki/Visibility

#if defined _WIN32 || defined __CYGWIN__
  #ifdef __GNUC__
    #define {macro}_EXPORT __attribute__ ((dllexport))
    #define {macro}_IMPORT __attribute__ ((dllimport))
  #else
    #define {macro}_EXPORT __declspec(dllexport)
    #define {macro}_IMPORT __declspec(dllimport)
  #endif
  #ifdef {macro}_BUILDING_LIBRARY
    #define {macro}_PUBLIC {macro}_EXPORT
  #else
    #define {macro}_PUBLIC {macro}_IMPORT
  #endif
  #define {macro}_PUBLIC_TYPE {macro}_PUBLIC
  #define {macro}_LOCAL
#else
  #define {macro}_EXPORT __attribute__ ((visibility("default")))
  #define {macro}_IMPORT
  #if __GNUC__ >= 4
    #define {macro}_PUBLIC __attribute__ ((visibility("default")))
    #define {macro}_LOCAL  __attribute__ ((visibility("hidden")))
  #else
    #define {macro}_PUBLIC
    #define {macro}_LOCAL
  #endif
  #define {macro}_PUBLIC_TYPE
#endif

#endif  // {macro}__VISIBILITY_CONTROL_H_
"""


def files(package: NewPackage) -> Iterator[Entry]:
    """Yield the sources of the node and of the library, if there are to be any."""
    name, library = package.name, package.library
    if package.node:
        yield File(f"src/{package.node}.cpp", _MAIN.format(package=name))
    if library:
        class_name = "".join(library.replace("_", " ").title().split())
        guard = f"{name.upper()}__{library.upper()}_HPP_"
        include = f"include/{name}"
        yield File(f"{include}/{library}.hpp", _HEADER.format(package=name, guard=guard, of=class_name))
        yield File(f"src/{library}.cpp", _LIBRARY.format(package=name, library=library, of=class_name))
        yield File(f"{include}/visibility_control.h", _VISIBILITY.format(macro=name.upper()))
