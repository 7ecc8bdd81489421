"""File locking with a timeout, which flock lacks: the holder of a lock may be a stopped process."""

from __future__ import annotations

import fcntl
import time

_RETRY_INTERVAL_S = 0.01


def lock(handle: int, limit_s: float) -> bool:
    """Lock an open file exclusively; return False if another process has held the lock for `limit_s` seconds.

    The lock is released when `handle` is closed. Raises OSError.
    """
    deadline = time.monotonic() + limit_s
    while True:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except BlockingIOError:
            if time.monotonic() > deadline:
                return False
            time.sleep(_RETRY_INTERVAL_S)
