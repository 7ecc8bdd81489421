"""What a build needs of the machine: compilers and Python's headers, and how to get them."""

from __future__ import annotations

import os
import shlex
import shutil
import sysconfig
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Toolchain:
    """The commands that compile C and C++."""

    c: tuple[str, ...]
    cpp: tuple[str, ...]


def find_toolchain(environ: Mapping[str, str] = os.environ) -> Toolchain | str:
    """Return what compiles here, or one sentence: what is missing, and the command that installs it."""
    c = _compiler("CC", ("gcc", "cc", "clang"), environ)
    cpp = _compiler("CXX", ("g++", "c++", "clang++"), environ)
    if not c or not cpp:
        return f"message types are compiled, and there is no C++ compiler here: {_install('g++', environ)}"
    if not Path(sysconfig.get_path("include"), "Python.h").is_file():
        package = f"python{sysconfig.get_python_version()}-dev"
        return f"message types are compiled, and this Python has no C headers (Python.h): {_install(package, environ)}"
    return Toolchain(c, cpp)


def _compiler(variable: str, names: tuple[str, ...], environ: Mapping[str, str]) -> tuple[str, ...]:
    given = shlex.split(environ.get(variable, ""))
    for words in [given] if given else [[name] for name in names]:
        if shutil.which(words[0], path=environ.get("PATH")):
            return tuple(words)
    return ()


def _install(package: str, environ: Mapping[str, str]) -> str:
    """Return the command that installs a package of Debian's or Ubuntu's, or what corresponds to it elsewhere."""
    others = {
        "dnf": {"g++": "gcc-c++"}.get(package, "python3-devel"),
        "pacman": {"g++": "gcc"}.get(package, "python"),
        "zypper": {"g++": "gcc-c++"}.get(package, "python3-devel"),
    }
    verbs = {"dnf": "install", "pacman": "-S", "zypper": "install"}
    for manager, name in others.items():
        if not shutil.which("apt-get", path=environ.get("PATH")) and shutil.which(manager, path=environ.get("PATH")):
            return f"sudo {manager} {verbs[manager]} {name}"
    return f"sudo apt-get install {package}"
