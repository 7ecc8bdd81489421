"""`ros-tutor author check --watch`: prove again what the author changes."""

from __future__ import annotations

import argparse
import os
import re
import signal
import subprocess
import time
from collections.abc import Iterable
from pathlib import Path

from tutor import interpreter
from tutor.cli import context, terminal
from tutor.errors import UsageError

_POLL_INTERVAL_S = 0.3
_INTERRUPT_AGAIN_S = 2.0
_EXERCISE = re.compile(r"([a-z]+\d+)_(\d+)")
_FOLDERS = ("lessons", "checks", "submissions")

Snapshot = dict[Path, tuple[int, int]]
"""Each file of a course with its time of change and its size."""


def run(arguments: argparse.Namespace) -> int:
    """Prove now, and what has changed after each save, until Ctrl+C. Each time is a process of its own."""
    own = context.own_courses(arguments)
    if len(own.folders) != 1 or own.given[0] != str(own.folders[0]):
        raise UsageError("--watch needs one course of your own: name its folder with --lessons DIR")
    (root,) = own.folders
    wanted = list(arguments.exercises)
    words = wanted
    while True:
        before = _snapshot(root)
        _prove(root, words, arguments.submissions)
        terminal.say("waiting for the next save; Ctrl+C ends it")
        while (after := _snapshot(root)) == before:
            time.sleep(_POLL_INTERVAL_S)
        words = changed(root, (path for path in before.keys() | after.keys() if before.get(path) != after.get(path)))
        words = words or wanted


def changed(root: Path, paths: Iterable[Path]) -> list[str]:
    """Return what to prove again, as `author check` takes it: exercises and submissions; nothing if that is all."""
    words: set[str] = set()
    for path in paths:
        kind, *parts = path.relative_to(root).parts
        named = _EXERCISE.match(parts[0]) if parts else None
        if kind not in _FOLDERS or named is None:
            return []  # of the whole course, or of several exercises
        exercise = ".".join(named.groups())
        whole = kind != "submissions" or len(parts) < 3
        words.add(exercise if whole else "/".join((exercise, parts[1], parts[2].removesuffix(".yaml"))))
    return sorted(word for word in words if word.partition("/")[0] not in words - {word})


def _prove(root: Path, words: list[str], submissions: Path | None) -> None:
    options = [] if submissions is None else ["--submissions", str(submissions)]
    command = interpreter.module_command("tutor", "author", "check", *words, "--lessons", str(root), *options)
    child = subprocess.Popen(command)
    try:
        child.wait()
    except KeyboardInterrupt:  # the terminal has sent it to the child as well
        try:
            child.wait(_INTERRUPT_AGAIN_S)
        except subprocess.TimeoutExpired:
            child.send_signal(signal.SIGINT)
            child.wait()
        raise


def _snapshot(root: Path) -> Snapshot:
    found: Snapshot = {}
    for folder, names, files in os.walk(root):
        names[:] = [name for name in names if name != "__pycache__" and not name.startswith(".")]
        for name in files:
            path = Path(folder, name)
            try:
                status = path.stat()
            except OSError:
                continue
            found[path] = (status.st_mtime_ns, status.st_size)
    return found
