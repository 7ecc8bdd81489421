"""Takes a file lock within a limit: flock knows none of its own, and its holder may be stopped."""

from __future__ import annotations

import fcntl
import time

_RETRY_S = 0.01


def lock(handle: int, limit_s: float) -> bool:
    """Lock an open file for this process alone; False where another has kept it for `limit_s` seconds.

    It is unlocked when `handle` is closed. Raises OSError.
    """
    limit = time.monotonic() + limit_s
    while True:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except BlockingIOError:
            if time.monotonic() > limit:
                return False
            time.sleep(_RETRY_S)
