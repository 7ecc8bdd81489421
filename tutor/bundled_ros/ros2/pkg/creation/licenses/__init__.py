"""The licenses that ament knows: `NAME.txt` beside this module is the text of each."""

from __future__ import annotations

from pathlib import Path

NAMES = (
    "Apache-2.0",
    "BSL-1.0",
    "BSD-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "GPL-3.0-only",
    "LGPL-3.0-only",
    "MIT",
    "MIT-0",
)
"""SPDX identifiers, in the order in which `ros2 pkg create` lists them."""


def text_of(name: str) -> str | None:
    """Return the text of a license; None if its name is not in NAMES."""
    return Path(__file__).with_name(f"{name}.txt").read_text(encoding="utf-8") if name in NAMES else None
