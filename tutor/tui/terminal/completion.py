"""Tab completion at the prompt: `ros2` and `ros-tutor` complete themselves; anything else is a program or a path."""

from __future__ import annotations

import asyncio
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tutor import private_folders

TIMEOUT_S = 5.0
"""Timeout for a program to complete itself, which may involve discovery of topics and nodes."""

PROGRAMS = ("cd", "clear", "export", "python3", "ros-tutor", "ros2")
_ARGCOMPLETE_PROGRAMS = ("ros2", "ros-tutor")
_SEPARATOR = "\013"


@dataclass(frozen=True, slots=True)
class Completion:
    """The line as completed so far, its cursor position, and the candidates to choose from if it is ambiguous."""

    line: str
    cursor: int
    offers: tuple[str, ...] = ()


async def complete(line: str, cursor: int, env: Mapping[str, str], cwd: Path) -> Completion:
    """Complete the word before the cursor."""
    before, after = line[:cursor], line[cursor:]
    command = re.split(r"[;&|]\s*", before)[-1].lstrip()
    word = re.search(r"[^\s]*$", command)
    typed = word[0] if word else ""
    words = command.split()
    if len(words) < 1 or (len(words) == 1 and typed):
        offers = [program for program in PROGRAMS if program.startswith(typed)]
    elif words[0] in _ARGCOMPLETE_PROGRAMS:
        offers = await _run_argcomplete(words[0], command, env, cwd)
    else:
        offers = complete_path(typed, cwd)
    return merge(before, after, typed, offers)


def merge(before: str, after: str, typed: str, offers: Sequence[str]) -> Completion:
    """Insert the common prefix of all fitting offers; a single one is followed by a space."""
    fitting = tuple(dict.fromkeys(offer for offer in offers if offer.startswith(typed)))
    if not fitting:
        return Completion(before + after, len(before))
    common = _common_prefix(fitting)
    if len(fitting) == 1 and not common.endswith(("/", ":=", " ", "=")):
        common += " "
    completed = before[: len(before) - len(typed)] + common
    return Completion(completed + after, len(completed), () if len(fitting) == 1 else fitting)


def _common_prefix(texts: Sequence[str]) -> str:
    """Return the longest common prefix."""
    first, last = min(texts), max(texts)
    return first[: next((at for at, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), len(first))]


def complete_path(typed: str, cwd: Path) -> list[str]:
    """Return the files and folders that complete a path; folders end with a slash, hidden ones need a typed dot."""
    folder, _, prefix = typed.rpartition("/")
    place = cwd / Path(folder + "/" if "/" in typed else ".").expanduser()
    try:
        entries = sorted(os.scandir(place), key=lambda entry: entry.name)
    except OSError:
        return []
    head = typed[: len(typed) - len(prefix)]
    return [
        f"{head}{entry.name}{'/' if entry.is_dir() else ''}"
        for entry in entries
        if entry.name.startswith(prefix) and (prefix.startswith(".") or not entry.name.startswith("."))
    ]


async def _run_argcomplete(program: str, command: str, env: Mapping[str, str], cwd: Path) -> list[str]:
    """Have a program complete its own command line through argcomplete, as bash would."""
    with private_folders.temporary("complete") as folder:
        answer = folder / "answer"
        answer.touch()
        request_env = {
            **env,
            "_ARGCOMPLETE": "1",
            "_ARGCOMPLETE_IFS": _SEPARATOR,
            "_ARGCOMPLETE_SHELL": "bash",
            "_ARGCOMPLETE_SUPPRESS_SPACE": "1",
            "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
            "COMP_LINE": command,
            "COMP_POINT": str(len(command)),
            "COMP_TYPE": "9",
        }
        try:
            process = await asyncio.create_subprocess_exec(
                "/bin/sh", "-c", program, env=request_env, cwd=cwd,
                stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.DEVNULL, stderr=asyncio.subprocess.DEVNULL,
            )  # fmt: skip
        except OSError:
            return []
        try:
            await asyncio.wait_for(process.wait(), TIMEOUT_S)
        except TimeoutError:
            return []
        finally:
            if process.returncode is None:
                process.kill()
                await process.wait()
        text = answer.read_text(encoding="utf-8", errors="replace")
    return [offer.replace("\\", "") for offer in text.split(_SEPARATOR) if offer]
