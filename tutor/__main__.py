"""`python -I -m tutor`: what `ros-tutor` runs."""

from __future__ import annotations

import os
import signal
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn

    from _typeshed import Unused

_INTERRUPTED = 130


def _interrupted(*_: Unused) -> NoReturn:
    os._exit(_INTERRUPTED)


def _not_lost(lost: sys.UnraisableHookArgs) -> None:
    """Where Ctrl+C falls into a destructor or a callback of Python's, it would only be printed."""
    if lost.exc_type is KeyboardInterrupt:
        _interrupted()
    sys.__unraisablehook__(lost)


if __name__ == "__main__":
    ours = signal.getsignal(signal.SIGINT) is signal.default_int_handler  # not ignored, as in a job of the background
    sys.unraisablehook = _not_lost
    if ours:  # nothing has begun while this is imported
        signal.signal(signal.SIGINT, _interrupted)
    from tutor.interpreter import answer_ctrl_c, collect_garbage_seldom

    answer_ctrl_c()
    collect_garbage_seldom()
    from tutor.cli import main

    try:
        if ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        code = main()
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # all is said
    except KeyboardInterrupt:
        _interrupted()
    sys.exit(code)
