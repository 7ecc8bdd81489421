"""`python -I -m tutor`: what `ros-tutor` runs."""

import os
import signal
import sys

if __name__ == "__main__":
    ours = signal.getsignal(signal.SIGINT) is signal.default_int_handler  # not ignored, as in a job of the background
    if ours:  # nothing has begun while this is imported
        signal.signal(signal.SIGINT, lambda *_: os._exit(130))
    from tutor.cli import main

    if ours:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    sys.exit(main())
