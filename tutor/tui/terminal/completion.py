"""What Tab offers at the prompt: `ros2` and `ros-tutor` complete themselves, everything else is a path or a program."""

from __future__ import annotations

import asyncio
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tutor import private_folders

LIMIT_S = 5.0
"""How long a program may take to say what it offers: topics and nodes are looked up."""

PROGRAMS = ("cd", "clear", "export", "python3", "ros-tutor", "ros2")
_OWN_COMPLETION = ("ros2", "ros-tutor")
_SEPARATOR = "\013"


@dataclass(frozen=True, slots=True)
class Completion:
    """The line as completed so far, where the cursor goes in it, and what to choose from where it is not yet clear."""

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
    elif words[0] in _OWN_COMPLETION:
        offers = await _ask(words[0], command, env, cwd)
    else:
        offers = paths(typed, cwd)
    return merge(before, after, typed, offers)


def merge(before: str, after: str, typed: str, offers: Sequence[str]) -> Completion:
    """Put in what all offers have in common; a single one whole, with a space after it."""
    fitting = tuple(dict.fromkeys(offer for offer in offers if offer.startswith(typed)))
    if not fitting:
        return Completion(before + after, len(before))
    common = _common(fitting)
    if len(fitting) == 1 and not common.endswith(("/", ":=", " ", "=")):
        common += " "
    done = before[: len(before) - len(typed)] + common
    return Completion(done + after, len(done), () if len(fitting) == 1 else fitting)


def _common(texts: Sequence[str]) -> str:
    """What all begin with."""
    first, last = min(texts), max(texts)
    return first[: next((at for at, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), len(first))]


def paths(typed: str, cwd: Path) -> list[str]:
    """The files and folders that begin so; a folder ends with a slash."""
    folder, _, begin = typed.rpartition("/")
    place = cwd / Path(folder + "/" if "/" in typed else ".").expanduser()
    try:
        entries = sorted(os.scandir(place), key=lambda entry: entry.name)
    except OSError:
        return []
    head = typed[: len(typed) - len(begin)]
    return [
        f"{head}{entry.name}{'/' if entry.is_dir() else ''}"
        for entry in entries
        if entry.name.startswith(begin) and (begin.startswith(".") or not entry.name.startswith("."))
    ]


async def _ask(program: str, command: str, env: Mapping[str, str], cwd: Path) -> list[str]:
    """Ask a program that completes itself, in the way in which a shell does (argcomplete's)."""
    with private_folders.temporary("complete") as folder:
        answer = folder / "answer"
        answer.touch()
        asked = {
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
                "/bin/sh", "-c", program, env=asked, cwd=cwd,
                stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.DEVNULL, stderr=asyncio.subprocess.DEVNULL,
            )  # fmt: skip
        except OSError:
            return []
        try:
            await asyncio.wait_for(process.wait(), LIMIT_S)
        except TimeoutError:
            return []
        finally:
            if process.returncode is None:
                process.kill()
                await process.wait()
        text = answer.read_text(encoding="utf-8", errors="replace")
    return [offer.replace("\\", "") for offer in text.split(_SEPARATOR) if offer]
