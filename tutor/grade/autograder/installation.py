"""Makes a wheel of this installation of ros-tutor, for machines that it has to be brought to."""

from __future__ import annotations

import base64
import platform
import re
import stat
import sys
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from io import BytesIO
from pathlib import Path

from tutor import __version__
from tutor.content.loader import BUNDLED
from tutor.errors import EngineError

_NAME = "ros-tutor"
_FOLDER = "ros_tutor"
_PACKAGES = ("tutor", "checks", "lessons")
_CPYTHON = f"cp{sys.version_info.major}{sys.version_info.minor}"
_REQUIREMENT = re.compile(r"[A-Za-z0-9._-]+")
_NOT_NEEDED = Path("tutor", "bundled_ros", "interfaces")  # sources of what is in tutor/bundled_ros/prefix
_EPOCH = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True, slots=True)
class Wheel:
    """A wheel's file name, and what is in the file."""

    name: str
    content: bytes


def wheel() -> Wheel:
    """Return this installation as a wheel, for this kind of processor: it holds compiled messages.

    Installed from one or run from a clone, it makes no difference. Raises EngineError and OSError.
    """
    tag = f"{_CPYTHON}-{_CPYTHON}-linux_{platform.machine()}"
    record = f"ros_tutor-{__version__}.dist-info"
    files = {
        f"{_FOLDER}/{path.relative_to(BUNDLED).as_posix()}": path.read_bytes()
        for name in _PACKAGES
        for path in files_below(BUNDLED / name)
        if not path.relative_to(BUNDLED).is_relative_to(_NOT_NEEDED)
    }
    files[f"{record}/METADATA"] = _metadata().encode()
    files[f"{record}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: ros-tutor {__version__}\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    )
    files[f"{record}/RECORD"] = "".join(
        [*(f"{name},{_hash(content)},{len(content)}\n" for name, content in files.items()), f"{record}/RECORD,,\n"]
    ).encode()
    return Wheel(f"ros_tutor-{__version__}-{tag}.whl", zip_of(files))


def zip_of(files: Mapping[str, bytes]) -> bytes:
    """Return an archive of files by name, equal for equal files. Scripts are executable in it."""
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (stat.S_IFREG | (0o755 if content.startswith(b"#!") else 0o644)) << 16
            archive.writestr(entry, content)
    return buffer.getvalue()


def constraints() -> str:
    """Return the versions of everything that ros-tutor requires, as they are here: a line of `name==version` each.

    With these, a submission gets the verdict there that it gets here.
    """
    versions: dict[str, str] = {}
    todo = [_distribution()]
    while todo:
        for requirement in todo.pop().requires or ():
            match = _REQUIREMENT.match(requirement)
            name = re.sub(r"[-_.]+", "-", match[0]).lower() if match is not None else ""
            if not name or name in versions or "extra ==" in requirement:
                continue
            try:
                required = distribution(name)
            except PackageNotFoundError:  # required only elsewhere
                continue
            versions[name] = required.version
            todo.append(required)
    return "".join(f"{name}=={version}\n" for name, version in sorted(versions.items()))


def files_below(folder: Path) -> Iterator[Path]:
    """Yield the files below a folder, without hidden ones and compiled Python."""
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        hidden = any(part.startswith(".") and part != ".stamp" for part in parts)
        if path.is_file() and not hidden and "__pycache__" not in parts:
            yield path


def _distribution() -> Distribution:
    try:
        return distribution(_NAME)
    except PackageNotFoundError as error:
        raise EngineError("ros-tutor is not installed here as a package", "install it, or start ./ros-tutor") from error


def _metadata() -> str:
    text = _distribution().read_text("METADATA")
    if not text:
        raise EngineError("the metadata of this installation is missing", "install ros-tutor again")
    return text


def _hash(content: bytes) -> str:
    return "sha256=" + base64.urlsafe_b64encode(sha256(content).digest()).decode().rstrip("=")
