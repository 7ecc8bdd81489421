"""Installs the files in dist/ in every way that README names, as several users, and prints a table of what works.

`python3 packaging/try_install` runs it. Each installation is a new one, with a home of its own, from an index on this
machine, which is filled once. Other users are only tried as root.
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from local_index import LocalIndex
from places import CLONE, READ_ONLY, SELF, STRANGER, Failed, Place, Users
from timing import times
from trials import try_program
from ways import WAYS, Tools


def main() -> int:
    """Print the table; return 0 if everything works."""
    parser = argparse.ArgumentParser(prog="packaging/try_install", description=__doc__)
    parser.add_argument("--dist", type=Path, default=CLONE / "dist", help="the folder with the files (dist)")
    parser.add_argument("--way", action="append", choices=list(WAYS), help="try only this way of installing")
    options = parser.parse_args()
    dist = options.dist.resolve()
    files = sorted([*dist.glob("ros_tutor-*.whl"), *dist.glob("ros_tutor-*.tar.gz")])
    if not files:
        parser.error(f"{dist} has no files of ros-tutor: packaging/build makes them")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # leaving no account behind
    with tempfile.TemporaryDirectory(prefix="ros-tutor-try-") as name, ExitStack() as stack:
        work = Path(name)
        users = stack.enter_context(Users(work))
        tools = Tools.make(work, dist, stack.enter_context(LocalIndex(work / "index")))
        rows = [
            (way, user, _result(way, users.place(user, way), tools))
            for way in options.way or WAYS
            for user in ((SELF, STRANGER, READ_ONLY) if os.getuid() == 0 else (SELF,))
            if user == SELF or not WAYS[way].once
        ]
        print(table(("way of installing", "user", "result"), rows))
        sizes = [(file.name, f"{file.stat().st_size / 1e6:.2f} MB") for file in files]
        print(table(("file", "size"), sizes))
        if ("uvx", SELF, "works") in rows:
            print(table(("uvx ros-tutor", "cold", "warm"), times(users.place(SELF, "times"), tools)))
    return 0 if all(result == "works" for *_, result in rows) else 1


def _result(way: str, place: Place, tools: Tools) -> str:
    print(f"{way}, {place.user}: ", end="", file=sys.stderr, flush=True)
    result = "works"
    try:
        program = WAYS[way].install(place, tools)
        try_program(place, program)
    except Failed as failure:
        result = f"FAILED: {failure}"
    finally:
        subprocess.run(["chmod", "-R", "u+w", place.home], check=True)
        shutil.rmtree(place.home.parent, ignore_errors=True)
    print(result, file=sys.stderr, flush=True)
    return result


def table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    widths = [max(len(row[column]) for row in [heads, *rows]) for column in range(len(heads))]
    lines = [heads, ["-" * width for width in widths], *rows]
    return "\n".join("| " + " | ".join(map(str.ljust, line, widths)) + " |" for line in lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
