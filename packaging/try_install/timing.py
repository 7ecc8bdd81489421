"""How long it takes from `uvx ros-tutor` to the first screen, and to the first verdict."""

from __future__ import annotations

import fcntl
import os
import pty
import select
import shutil
import signal
import struct
import termios
import time

from places import LIMIT_S, Failed, Place
from ways import Tools

_ON_THE_FIRST_SCREEN = b"Quit"  # in its footer
_SIZE = (40, 120)


def times(place: Place, tools: Tools) -> list[tuple[str, ...]]:
    """Return a row for the first screen and one for the first verdict. Cold is with an empty cache of uv."""
    place.env.update(tools.env)
    uvx = str(tools.bin / "uvx")
    rows: list[tuple[str, ...]] = []
    for name, measure in (("first screen", _to_first_screen), ("first verdict", _to_first_verdict)):
        shutil.rmtree(place.home / ".cache", ignore_errors=True)
        rows.append((name, *(f"{measure(place, uvx):.1f} s" for _ in ("cold", "warm"))))
    return rows


def _to_first_verdict(place: Place, uvx: str) -> float:
    started = time.monotonic()
    place.use(uvx, "ros-tutor", "check", "i1.1", "--solution")
    return time.monotonic() - started


def _to_first_screen(place: Place, uvx: str) -> float:
    command = place.command([uvx, "ros-tutor"], place.account, place.home, {})
    started = time.monotonic()
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(place.elsewhere)
        os.execvp(command[0], command)
    try:
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", *_SIZE, 0, 0))
        shown = b""
        while _ON_THE_FIRST_SCREEN not in shown:
            if not select.select([terminal], [], [], LIMIT_S)[0]:
                raise Failed(f"no screen after {LIMIT_S:.0f} s: {shown[-300:]!r}")
            try:
                shown += os.read(terminal, 1 << 16)
            except OSError as error:  # the program has ended
                raise Failed(f"no screen: {shown[-300:]!r}") from error
        return time.monotonic() - started
    finally:
        os.close(terminal)  # hangs up
        os.kill(pid, signal.SIGHUP)
        os.waitpid(pid, 0)
