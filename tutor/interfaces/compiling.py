"""Compiles generated sources: one library for a package's types, and the Python module that loads it.

colcon's build makes eight libraries of the same sources, for RMWs and languages that nothing here runs with. One has
the type support of our RMW and what Python needs, which takes a tenth of the time.
"""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from tutor.interfaces.toolchain import Toolchain

_FLAGS = ("-fPIC", "-O1", "-DNDEBUG", "-w")
_RUNTIME = (
    *("rosidl_runtime_c", "rosidl_typesupport_c", "rosidl_typesupport_fastrtps_c", "rosidl_typesupport_fastrtps_cpp"),
    *("rosidl_typesupport_introspection_c", "fastcdr", "rmw", "rcutils"),
)
_TYPE_SUPPORTS = ("rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c")
_OF_A_DEPENDENCY = ("rosidl_generator_c", *_TYPE_SUPPORTS, "rosidl_generator_py")
_LIMIT_S = 300.0


class CompileError(Exception):
    """A compiler failed; the message is its first error."""


@dataclass(frozen=True, slots=True)
class Python:
    """The folders of Python's and NumPy's headers, and how the file name of a compiled module ends."""

    includes: tuple[str, ...]
    suffix: str


@dataclass(frozen=True, slots=True)
class Job:
    """What is compiled: `sources` and `python` are the generated folders of the package, `scratch` is for objects.

    `prefixes`: the ament prefixes of ROS; `built`: those of the packages of the workspace that this one depends on.
    """

    package: str
    sources: tuple[Path, ...]
    python: Path
    scratch: Path
    library_dir: Path
    prefixes: tuple[Path, ...]
    built: tuple[Path, ...]
    dependencies: tuple[str, ...]


def compile_package(job: Job, tools: Toolchain, python: Python, progress: Callable[[float], object]) -> None:
    """Compile the library and the module into place; `progress` is told the fraction done. Raises CompileError."""
    folders = [*(folder.parent for folder in job.sources), *_include_folders(job), *python.includes]
    includes = [f"-I{folder}" for folder in folders]
    support = [path for folder in job.sources for path in sorted(folder.rglob("*.cpp"))]
    together = job.scratch / "type_support.cpp"  # they share their headers, which are most of the work
    together.write_text("".join(f'#include "{path}"\n' for path in support), encoding="utf-8")
    c_sources = [path for folder in job.sources for path in sorted(folder.rglob("*.c"))]
    c_sources += sorted(job.python.glob("*/*_s.c"))
    entry = next(job.python.glob("_*_s.ep.rosidl_typesupport_c.c"))
    commands = [
        [*tools.cpp, *_FLAGS, *includes, "-c", str(together), "-o", str(job.scratch / "type_support.o")],
        *(
            [*tools.c, *_FLAGS, *includes, "-c", str(source), "-o", str(job.scratch / f"c{number}.o")]
            for number, source in enumerate([*c_sources, entry])
        ),
    ]
    done = 0

    def count(_: object) -> None:
        nonlocal done
        done += 1
        progress(done / (len(commands) + 1))

    _run_all(commands, count)
    library, alias = (f"{job.package}__{name}" for name in _TYPE_SUPPORTS)  # each is loaded by its name
    job.library_dir.mkdir(parents=True, exist_ok=True)
    searched = _library_folders(job)
    search = [option for folder in searched for option in (f"-L{folder}", f"-Wl,-rpath,{folder}")]
    objects = ["type_support.o", *(f"c{number}.o" for number in range(len(c_sources)))]
    _run(
        [
            *(*tools.cpp, "-shared", "-o", str(job.library_dir / f"lib{library}.so"), f"-Wl,-soname,lib{library}.so"),
            *(str(job.scratch / name) for name in objects),
            *("-Wl,--no-as-needed", "-Wl,--allow-shlib-undefined", *search, *_libraries(job, searched)),
        ]
    )
    # An empty library that needs the other, for a process that finds libraries by the names of those it has loaded.
    beside = ["-Wl,--no-as-needed", "-Wl,--allow-shlib-undefined", f"-L{job.library_dir}", f"-l{library}"]
    named = [f"-Wl,-soname,lib{alias}.so", "-Wl,-rpath,$ORIGIN"]
    _run([*tools.c, "-shared", "-o", str(job.library_dir / f"lib{alias}.so"), *named, *beside])
    module = job.python / f"{job.package}_s__rosidl_typesupport_c{python.suffix}"
    own = ["-Wl,-rpath,$ORIGIN/../../lib", f"-L{job.library_dir}", f"-l{library}"]
    _run(
        [
            *tools.c,
            "-shared",
            "-o",
            str(module),
            str(job.scratch / f"c{len(c_sources)}.o"),
            "-Wl,--allow-shlib-undefined",
            *own,
        ]
    )


def _include_folders(job: Job) -> list[Path]:
    """Each package of ROS has its headers in a folder of its own."""
    found = [folder for prefix in job.prefixes for folder in sorted((prefix / "include").glob("*")) if folder.is_dir()]
    return [*(prefix / "include" for prefix in job.built), *found, *(prefix / "include" for prefix in job.prefixes)]


def _library_folders(job: Job) -> list[Path]:
    return [prefix / "lib" for prefix in (*job.built, *job.prefixes) if (prefix / "lib").is_dir()]


def _libraries(job: Job, folders: Sequence[Path]) -> list[str]:
    """Return the linker's options for the libraries that are there of those that the sources may use."""
    wanted = [*(f"{name}__{kind}" for name in job.dependencies for kind in _OF_A_DEPENDENCY), *_RUNTIME]
    present = [name for name in wanted if any((folder / f"lib{name}.so").exists() for folder in folders)]
    return [f"-l{name}" for name in present]


def _run_all(commands: Iterable[list[str]], done: Callable[[object], None]) -> None:
    import os

    with ThreadPoolExecutor(max(1, len(os.sched_getaffinity(0)))) as pool:
        futures = [pool.submit(_run, command) for command in commands]
        for future in futures:
            future.add_done_callback(done)
        for future in futures:
            future.result()


def run_to_end(
    command: list[str], limit_s: float, environment: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """Run a tool, in our environment by default. Raises CompileError if it cannot be run, or takes too long."""
    try:
        return subprocess.run(
            command,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=limit_s,
            check=False,
        )
    except (OSError, subprocess.SubprocessError) as error:
        raise CompileError(str(error)) from error


def _run(command: list[str]) -> None:
    ended = run_to_end(command, _LIMIT_S)
    if ended.returncode:
        lines = ended.stderr.splitlines()
        first = next((line for line in lines if "error" in line or "undefined" in line), lines[-1] if lines else "")
        raise CompileError(first.strip() or f"{command[0]} ended with {ended.returncode}")
