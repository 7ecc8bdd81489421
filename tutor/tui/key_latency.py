"""Keep Python's garbage collection out of the way of the start, and of key presses while much is being painted."""

from __future__ import annotations

import gc
import sys

_SWITCH_INTERVAL_S = 0.0005
"""Python's thread switch interval for the app, in seconds."""


def pause_collection() -> None:
    """Collect no garbage until `resume_collection`: nearly all that the start makes stays alive."""
    gc.disable()


def resume_collection() -> None:
    """Collect garbage again, if that was paused; objects alive now are excluded, for `reduce_key_latency`'s reason."""
    if not gc.isenabled():
        gc.freeze()
        gc.enable()


def reduce_key_latency() -> None:
    """Keep the interpreter from delaying key presses while much is being painted.

    Objects alive now are excluded from garbage collection, which would scan them all each time; those that become
    garbage are collected at the next call. A short switch interval lets the thread that writes to the terminal run
    without waiting for the painting thread for the default 5 ms.
    """
    gc.unfreeze()
    gc.collect()
    gc.freeze()
    sys.setswitchinterval(_SWITCH_INTERVAL_S)
