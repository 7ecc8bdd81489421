"""Bounds what learners' messages take of our memory, however large a single one is.

Fast DDS puts a message together before any callback, and no setting of it bounds that: one of 500 MB takes as
much, in each participant that it goes to. So the large blocks that this process has are looked at all the time; where
they are too many, the participant that is receiving leaves what it receives.
"""

from __future__ import annotations

import ctypes
import os
import threading
import time
from functools import cache
from typing import Protocol

MOST_BYTES = 32_000_000
"""What the large blocks may take, beyond the usual. To take a message that has come makes up to three copies of it."""

EVERY_S = 0.02
_LARGE = 65_536
"""A block of this size is one that the system keeps a count of; no ordinary check has more than a few."""

_USUAL_BYTES = 1_000_000
"""What an observer has of them: 660 KB, measured."""

_LOOK_S = 0.01
_MUCH_NS = 1_000_000
"""A participant that takes 1 ms of CPU time in 10 ms is receiving much: ten times what a topic of 1 kHz asks for."""

_PERSISTS_S = 1.5
"""Where so much is held for longer than this, and nobody is receiving any more, all leave what they receive.

To leave a topic takes some tenths of a second while Fast DDS is busy with what comes in on it.
"""


class Guarded(Protocol):
    """One of our participants, which receives from a learner's nodes."""

    threads: frozenset[str]
    """The threads of this process that receive for it, as the system numbers them."""

    def pause(self, paused: bool) -> None:
        """Take nothing of what has been received, or take it again. Called in the guard's thread; raises nothing."""

    def drop_received(self) -> None:
        """Leave what is too large to be received. Called in the guard's thread; raises nothing."""


_guarded: set[Guarded] = set()
_lock = threading.Lock()
_thread: threading.Thread | None = None


def guard(one: Guarded) -> None:
    """Have `one` drop what it receives when it is too much, from now on until `release`."""
    global _thread
    with _lock:
        _guarded.add(one)
        if _thread is None and _large_bytes() is not None:
            _thread = threading.Thread(target=_run, name="memory_guard", daemon=True)
            _thread.start()


def release(one: Guarded) -> None:
    """No longer guard it."""
    with _lock:
        _guarded.discard(one)


def threads() -> frozenset[str]:
    """The threads of this process, as the system numbers them."""
    return frozenset(os.listdir("/proc/self/task"))


class _MallInfo(ctypes.Structure):
    _fields_ = tuple(
        (name, ctypes.c_size_t)
        for name in (
            "arena",
            "ordblks",
            "smblks",
            "hblks",
            "hblkhd",
            "usmblks",
            "fsmblks",
            "uordblks",
            "fordblks",
            "keepcost",
        )
    )


@cache
def _library() -> ctypes.CDLL | None:
    """The C library, set to count large blocks; None where it is none that can (glibc before 2.33)."""
    library = ctypes.CDLL(None)
    if not hasattr(library, "mallinfo2"):
        return None
    library.mallinfo2.restype = _MallInfo
    m_mmap_threshold, m_trim_threshold = -3, -1
    library.mallopt(m_mmap_threshold, _LARGE)
    library.mallopt(m_trim_threshold, 16 * _LARGE)
    return library


def _large_bytes() -> int | None:
    library = _library()
    return None if library is None else int(library.mallinfo2().hblkhd)


def _run() -> None:
    global _thread
    before = _large_bytes() or 0
    since: float | None = None
    while True:
        with _lock:
            watched = tuple(_guarded)
            if not watched:
                _thread = None
                return
        time.sleep(EVERY_S)
        exceeds = _exceeds(before + MOST_BYTES + len(watched) * _USUAL_BYTES)
        if exceeds or since is not None:  # an innocent node loses nothing: what is sent to it waits
            for one in watched:
                one.pause(exceeds)
        if not exceeds:
            since = None
            continue
        now = time.monotonic()
        if receiving := _receiving(watched):
            since = now
        elif since is None or now - since < _PERSISTS_S:
            since = since or now
            continue
        for one in receiving or watched:
            one.drop_received()


def _exceeds(most: int) -> bool:
    return (_large_bytes() or 0) > most


def _receiving(watched: tuple[Guarded, ...]) -> tuple[Guarded, ...]:
    """Those that are receiving much right now, by the CPU time of their threads."""
    before = [_cpu_ns(one) for one in watched]
    time.sleep(_LOOK_S)
    had = [_cpu_ns(one) - ns for one, ns in zip(watched, before, strict=True)]
    least = max(_MUCH_NS, max(had) // 4)
    return tuple(one for one, ns in zip(watched, had, strict=True) if ns >= least)


def _cpu_ns(one: Guarded) -> int:
    total = 0
    for thread in one.threads:
        try:
            with open(f"/proc/self/task/{thread}/schedstat", "rb") as file:
                total += int(file.read().split()[0])
        except (OSError, IndexError, ValueError):
            pass
    return total
