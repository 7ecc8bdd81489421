"""`python -I -m tutor`, which the `ros-tutor` command runs."""

from __future__ import annotations

import os
import signal
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn

    from _typeshed import Unused

_SIGINT_EXIT_CODE = 130


def _exit_interrupted(*_: Unused) -> NoReturn:
    os._exit(_SIGINT_EXIT_CODE)


def _unraisable_hook(unraisable: sys.UnraisableHookArgs) -> None:
    """Exit on a Ctrl+C that lands in a destructor or callback, where Python would only print the exception."""
    if unraisable.exc_type is KeyboardInterrupt:
        _exit_interrupted()
    sys.__unraisablehook__(unraisable)


if __name__ == "__main__":
    # False in a background job, where SIGINT is ignored.
    handles_sigint = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    sys.unraisablehook = _unraisable_hook
    if handles_sigint:  # during the imports there is nothing to clean up
        signal.signal(signal.SIGINT, _exit_interrupted)
    from tutor.interpreter import reduce_gc_frequency, unblock_sigint

    unblock_sigint()
    reduce_gc_frequency()
    from tutor.cli import main

    try:
        if handles_sigint:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        code = main()
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # nothing is left to interrupt
    except KeyboardInterrupt:
        _exit_interrupted()
    sys.exit(code)
