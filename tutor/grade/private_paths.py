"""Leaves out of a report where on a teacher's machine the submission was judged."""

from __future__ import annotations

import os
import re
import sys
import tempfile
from functools import cache
from pathlib import Path

from msgspec import to_builtins

from tutor.json_codec import convert_to
from tutor.judge.result import Report

_NAME = r"[^\s/\"'`<>()\[\]{},;:=]++"

_LIBRARY = re.compile(rf"(?:/{_NAME})*/((?:site-packages|dist-packages|python3\.\d+)/(?={_NAME}))")


def clean(report: Report) -> Report:
    """Return the report with `without_private_paths` applied to each of its texts."""
    return convert_to(Report, _clean(to_builtins(report)))


def _clean(value: object) -> object:
    match value:
        case str():
            return without_private_paths(value)
        case dict():
            return {key: _clean(inner) for key, inner in value.items()}
        case list() | tuple():
            return [_clean(inner) for inner in value]
    return value


def without_private_paths(text: str) -> str:
    """Return the text with paths in the submission relative to it, and others without what is private in them.

    The submission's folder alone is written ".", another temporary folder of ours "…", a library's file
    "…/site-packages/rclpy/node.py", and the home of whoever runs this "~".
    """
    if "/" not in text:
        return text
    text = _submission().sub(lambda match: match[1] or ".", text)
    text = _temporary().sub("…", text)
    text = _LIBRARY.sub(r"…/\1", text)
    for folder, instead in _own_folders():
        text = re.sub(rf"(?<![\w./~…]){re.escape(folder)}(?![\w.-])", instead, text)
    return text


def _ours() -> str:
    """Match one of our temporary folders, here or on another machine (see `tutor.private_folders`)."""
    here = re.escape(tempfile.gettempdir())
    return rf"(?:{here}|(?:/{_NAME})*)/ros-tutor-\d+(?:-\w+)?"


@cache
def _submission() -> re.Pattern[str]:
    return re.compile(rf"{_ours()}/grade\.\w+/submission(?:/({_NAME}(?:/{_NAME})*)?)?")


@cache
def _temporary() -> re.Pattern[str]:
    return re.compile(rf"{_ours()}(?:/{_NAME})*")


@cache
def _own_folders() -> tuple[tuple[str, str], ...]:
    """The folders of this installation and the home, the longest first, and what to write instead of each."""
    folders = {
        str(Path(__file__).parents[2]): "…",
        sys.prefix: "…",
        os.path.expanduser("~"): "~",
    }
    usual = ("/", "/usr", "/usr/local")
    return tuple(sorted(((a, b) for a, b in folders.items() if a not in usual), key=lambda pair: -len(pair[0])))
