"""What a process has as its standard input: nothing, or a terminal where nobody types."""

from __future__ import annotations

import os


class Stdin:
    """The end that a process reads is `reader`, to be given to it and then closed by `close_reader`."""

    def __init__(self, *, terminal: bool) -> None:
        """Raises OSError."""
        self._kept = -1
        if terminal:
            # Held open by us, and nobody's controlling terminal: it sends no signals, and lasts until `close`.
            self._kept, self.reader = os.openpty()
        else:
            self.reader = os.open(os.devnull, os.O_RDONLY)

    def close_reader(self) -> None:
        """Close our copy of the process's end."""
        if self.reader >= 0:
            os.close(self.reader)
            self.reader = -1

    def close(self) -> None:
        """Hang up. May be called twice."""
        self.close_reader()
        if self._kept >= 0:
            os.close(self._kept)
            self._kept = -1
