"""Writes the sources of an interface package's Python modules and libraries; a program of its own.

It runs in the Python of the ROS in use and imports nothing of ours, only that ROS's own generators. Usage:
`generating.py ARGUMENTS`, a JSON file with

- `package`, and `files`: the .msg, .srv and .action files, relative to `folder`
- `share`: an output folder for what an installed package keeps in its share folder
- `sources`: an output folder for the C and C++ sources, whose parent is an include path
- `introspection`: another one, for the sources of that type support, whose names are those of others
- `python`: an output folder for the Python modules
- `scratch`: a folder for files of its own
- `dependencies`: the share folders of other packages, by name

It prints JSON: where the headers of Python and NumPy are, and how the file names of compiled modules end.
"""

from __future__ import annotations

import contextlib
import functools
import io
import json
import shutil
import sys
import sysconfig
from pathlib import Path
from typing import Any

from ament_index_python.packages import get_package_share_directory

FASTRTPS, INTROSPECTION = "rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"
"""The type supports that are built: those which the RMW uses that everything here runs with."""


def main() -> None:
    """Generate everything; a failure ends it with a traceback, after what the generators themselves wrote."""
    arguments = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    with contextlib.redirect_stdout(io.StringIO()):  # the generators tell which files they read
        _generate(arguments)
    import numpy

    includes = [sysconfig.get_path("include"), numpy.get_include()]
    print(json.dumps({"includes": includes, "suffix": sysconfig.get_config_var("EXT_SUFFIX")}))


def _generate(arguments: dict[str, Any]) -> None:
    _parse_each_file_once()
    import rosidl_generator_c
    import rosidl_generator_py
    import rosidl_generator_type_description
    import rosidl_typesupport_c
    import rosidl_typesupport_fastrtps_c
    import rosidl_typesupport_introspection_c

    package, origin = arguments["package"], Path(arguments["folder"])
    share, sources = Path(arguments["share"]), Path(arguments["sources"])
    idl_files = _write_definitions(package, origin, arguments["files"], share)
    common = {
        "package_name": package,
        "idl_tuples": [f"{share}:{file}" for file in idl_files],
        "ros_interface_files": [str(share / file) for file in arguments["files"]],
        "ros_interface_dependencies": [],
        "target_dependencies": [],
    }
    scratch = Path(arguments["scratch"])
    introspection = Path(arguments["introspection"])

    def run(generator: str, function: Any, output: Path, *more: Any, **extra: Any) -> None:
        templates = Path(get_package_share_directory(generator), "resource")
        path = scratch / f"{generator}.json"
        given = {**common, **extra, "output_dir": str(output), "template_dir": str(templates)}
        path.write_text(json.dumps(given), encoding="utf-8")
        function(str(path), *more)

    paths = [f"{name}:{place}" for name, place in arguments["dependencies"].items()]
    run(
        "rosidl_generator_type_description",
        rosidl_generator_type_description.generate_type_hash,
        share,
        include_paths=paths,
    )
    hashes = [f"{file}:{share / Path(file).with_suffix('.json')}" for file in idl_files]
    run("rosidl_generator_c", rosidl_generator_c.generate_c, sources, type_description_tuples=hashes)
    run(FASTRTPS, rosidl_typesupport_fastrtps_c.generate_typesupport_fastrtps_c, sources)
    run(INTROSPECTION, rosidl_typesupport_introspection_c.generate_c, introspection)
    run("rosidl_typesupport_c", rosidl_typesupport_c.generate_c, sources, [FASTRTPS, INTROSPECTION])
    run("rosidl_generator_py", rosidl_generator_py.generate_py, Path(arguments["python"]), ["rosidl_typesupport_c"])
    for generator, folder in (("rosidl_generator_c", sources), (FASTRTPS, sources), (INTROSPECTION, introspection)):
        _write_visibility_header(generator, package, folder)
    (Path(arguments["python"]) / "__init__.py").touch()


def _parse_each_file_once() -> None:
    """Keep the syntax trees: each of six generators parses the same files, which takes longer than all else they do."""
    import rosidl_parser.parser as parser

    parser.get_ast_from_idl_string = functools.cache(parser.get_ast_from_idl_string)


def _write_definitions(package: str, folder: Path, files: list[str], share: Path) -> list[str]:
    """Copy the definitions into the share folder and translate them; return the .idl files, relative to it."""
    from rosidl_adapter import convert_to_idl

    idl_files = []
    for file in map(Path, files):
        target = share / file
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(folder / file, target)
        convert_to_idl(folder, package, file, share)
        idl_files.append(file.with_suffix(".idl").as_posix())
    return idl_files


def _write_visibility_header(generator: str, package: str, sources: Path) -> None:
    name = f"{generator}__visibility_control.h"
    template = Path(get_package_share_directory(generator), "resource", f"{name}.in").read_text(encoding="utf-8")
    text = template.replace("@PROJECT_NAME@", package).replace("@PROJECT_NAME_UPPER@", package.upper())
    path = sources / "msg" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
