"""Runs a program on terminals of its own."""

from __future__ import annotations

import fcntl
import os
import pty
import select
import struct
import subprocess
import termios
import time
from collections.abc import Mapping

LIMIT_S = 30.0


def run_in_terminals(arguments: list[str], env: Mapping[str, str], rows: int = 40) -> tuple[int, str, str]:
    """Run with stdout and stderr on two terminals. Returns the exit code and what each of them showed."""
    (out, out_end), (err, err_end) = pty.openpty(), pty.openpty()
    for end in (out_end, err_end):
        fcntl.ioctl(end, termios.TIOCSWINSZ, struct.pack("HHHH", rows, 100, 0, 0))
    process = subprocess.Popen(arguments, stdin=out_end, stdout=out_end, stderr=err_end, env=dict(env))
    os.close(out_end)
    os.close(err_end)
    texts = {out: b"", err: b""}
    deadline = time.monotonic() + LIMIT_S
    open_ends = set(texts)
    while open_ends and time.monotonic() < deadline:
        for end in select.select(list(open_ends), [], [], 1.0)[0]:
            try:
                chunk = os.read(end, 65536)
            except OSError:  # Linux: the other side is closed
                chunk = b""
            texts[end] += chunk
            if not chunk:
                open_ends.discard(end)
    code = process.wait(timeout=LIMIT_S)
    os.close(out)
    os.close(err)
    return code, texts[out].decode(), texts[err].decode()
