"""Digests of the learner's files: they tell whether a file is still the version that was judged."""

from __future__ import annotations

from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path

from tutor.workspace.regular import read_regular

_MAX_BYTES = 1 << 24

Digests = Mapping[str, str]
"""From the name of a file to the digest of its content; empty for a file that cannot be read, or is not there."""


def digest_of_text(text: str) -> str:
    """Return the digest of a file with this text in UTF-8."""
    return sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def digest_of_file(path: Path) -> str:
    """Return the digest of a file; empty if it cannot be read."""
    try:
        content = read_regular(path, _MAX_BYTES)
    except OSError:
        return ""
    return "" if content is None else sha256(content).hexdigest()


def digests_of(files: Mapping[str, Path]) -> dict[str, str]:
    """Return the digests of these files, by name."""
    return {name: digest_of_file(path) for name, path in files.items()}


def has_changed(judged: Digests, current: Digests) -> bool | None:
    """Return whether one of the `current` files is not the version that was judged; None if that cannot be told.

    A file that was not there when it was judged may be missing from `judged`, or have an empty digest there.
    """
    if judged and any(judged.get(name, "") != digest for name, digest in current.items()):
        return True
    return False if judged and judged.keys() <= current.keys() else None


def version_of(digests: Digests) -> str:
    """Return what identifies these files in few characters; empty if there are none."""
    present = "".join(f"{name} {digest}\n" for name, digest in sorted(digests.items()) if digest)
    return sha256(present.encode()).hexdigest()[:16] if present else ""
