"""Bounds the memory that learners' messages take in this process, however large a single one is.

Fast DDS reassembles a message before any callback, and none of its settings bounds that: a message of 500 MB takes as
much in each participant that receives it. So we keep watching the total of large memory blocks in this process. When it
gets too high, the participant that is receiving unsubscribes from whatever it receives.
"""

from __future__ import annotations

import ctypes
import os
import threading
import time
from functools import cache
from typing import Protocol

MAX_BYTES = 32_000_000
"""Most memory in large blocks, above the baseline. Taking a received message makes up to three copies of it."""

_POLL_S = 0.02
_LARGE_BLOCK_BYTES = 65_536
"""malloc counts blocks of this size and more separately; an ordinary check has no more than a few."""

_OBSERVER_BYTES = 1_000_000
"""Allowance of large blocks for each observer; measured: 660 KB."""

_SAMPLE_S = 0.01
_BUSY_NS = 1_000_000
"""A participant that uses 1 ms of CPU time in 10 ms is receiving a lot: ten times as much as for a 1 kHz topic."""

_STUCK_S = 1.5
"""If the limit is exceeded for this long while nobody is receiving, all participants drop what they receive."""

_UNSURE_S = 7.5
"""The same while a participant waits for a CPU, since it may be receiving, which shows only once it gets to run; and
once a participant has been told to unsubscribe, which takes some tenths of a second while Fast DDS is busy with
incoming data on the topic, and much longer on a busy machine.
"""


class Guarded(Protocol):
    """One of our participants, which receives data from a learner's nodes."""

    threads: frozenset[str]
    """The ids of its receiving threads, as in /proc/self/task."""

    def pause(self, paused: bool) -> None:
        """Stop or resume taking received messages. Called in the guard's thread; must not raise."""

    def drop_received(self) -> None:
        """Unsubscribe from what is too large to receive. Called in the guard's thread; must not raise."""


_guarded: set[Guarded] = set()
_lock = threading.Lock()
_thread: threading.Thread | None = None


def guard(participant: Guarded) -> None:
    """Make a participant drop what it receives when it is too much, until `release`."""
    global _thread
    with _lock:
        _guarded.add(participant)
        if _thread is None and _large_bytes() is not None:
            _thread = threading.Thread(target=_run, name="memory_guard", daemon=True)
            _thread.start()


def release(participant: Guarded) -> None:
    """Stop guarding a participant."""
    with _lock:
        _guarded.discard(participant)


def threads() -> frozenset[str]:
    """Return the ids of this process's threads, as in /proc/self/task."""
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
    """Return the C library, configured to count large blocks; None if it cannot (glibc before 2.33)."""
    library = ctypes.CDLL(None)
    if not hasattr(library, "mallinfo2"):
        return None
    library.mallinfo2.restype = _MallInfo
    m_mmap_threshold, m_trim_threshold = -3, -1
    library.mallopt(m_mmap_threshold, _LARGE_BLOCK_BYTES)
    library.mallopt(m_trim_threshold, 16 * _LARGE_BLOCK_BYTES)
    return library


def _large_bytes() -> int | None:
    library = _library()
    return None if library is None else int(library.mallinfo2().hblkhd)


def _run() -> None:
    global _thread
    baseline = _large_bytes() or 0
    exceeded = dropping = False
    idle_s = 0.0  # how long we have seen nobody receiving: a time in which we ourselves did not run does not count
    while True:
        with _lock:
            watched = tuple(_guarded)
            if not watched:
                _thread = None
                return
        time.sleep(_POLL_S)
        exceeded_before = exceeded
        exceeded = _exceeds(baseline + MAX_BYTES + len(watched) * _OBSERVER_BYTES)
        if exceeded or exceeded_before:  # an innocent node loses nothing: its messages wait
            for participant in watched:
                participant.pause(exceeded)
        if not exceeded:
            dropping, idle_s = False, 0.0
            continue
        receiving, waits_for_cpu = _receiving(watched)
        if receiving:
            dropping, idle_s = True, 0.0
        else:
            idle_s += _POLL_S + _SAMPLE_S
            if idle_s < (_UNSURE_S if waits_for_cpu or dropping else _STUCK_S):
                continue
        for participant in receiving or watched:
            participant.drop_received()


def _exceeds(max_bytes: int) -> bool:
    return (_large_bytes() or 0) > max_bytes


def _receiving(watched: tuple[Guarded, ...]) -> tuple[tuple[Guarded, ...], bool]:
    """Return those that are receiving a lot right now, judged by the CPU time of their threads.

    Also return whether one of them has waited for a CPU meanwhile.
    """
    before = [_cpu_ns(participant) for participant in watched]
    time.sleep(_SAMPLE_S)
    after = [_cpu_ns(participant) for participant in watched]
    used = [ran - ran_before for (ran, _), (ran_before, _) in zip(after, before, strict=True)]
    waited = [waited - waited_before for (_, waited), (_, waited_before) in zip(after, before, strict=True)]
    threshold = max(_BUSY_NS, max(used) // 4)
    receiving = tuple(participant for participant, ns in zip(watched, used, strict=True) if ns >= threshold)
    return receiving, max(waited) >= _BUSY_NS


def _cpu_ns(participant: Guarded) -> tuple[int, int]:
    """How long a participant's threads have run, and waited for a CPU, in nanoseconds."""
    ran, waited = 0, 0
    for thread in participant.threads:
        try:
            with open(f"/proc/self/task/{thread}/schedstat", "rb") as file:
                fields = file.read().split()
            ran, waited = ran + int(fields[0]), waited + int(fields[1])
        except (OSError, IndexError, ValueError):
            pass
    return ran, waited
