"""The standard input of a process: /dev/null, or a terminal where nobody types."""

from __future__ import annotations

import os


class Stdin:
    """Pass the read end `reader` to a process, then call `close_reader`."""

    def __init__(self, *, terminal: bool) -> None:
        """Raises OSError."""
        self._master = -1
        if terminal:
            # We keep the other end open until `close`. As nobody's controlling terminal, it sends no signals.
            self._master, self.reader = os.openpty()
        else:
            self.reader = os.open(os.devnull, os.O_RDONLY)

    def close_reader(self) -> None:
        """Close our copy of the read end."""
        if self.reader >= 0:
            os.close(self.reader)
            self.reader = -1

    def close(self) -> None:
        """Hang up. Idempotent."""
        self.close_reader()
        if self._master >= 0:
            os.close(self._master)
            self._master = -1
