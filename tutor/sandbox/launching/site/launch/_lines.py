"""The output of a process, line by line."""

from __future__ import annotations

import codecs
from collections.abc import Callable


class Lines:
    """Cuts what comes into lines, without their ends; undecodable bytes are shown as such."""

    def __init__(self, show: Callable[[str], None]) -> None:
        self._show = show
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self._rest = ""
        self._all: list[str] = []

    @property
    def text(self) -> str:
        """All that has come."""
        return "".join(self._all)

    def feed(self, data: bytes, *, keep: bool = False) -> None:
        """Take some bytes; with `keep` they stay in `text`."""
        text = self._decoder.decode(data)
        if keep:
            self._all.append(text)
        *lines, self._rest = (self._rest + text).split("\n")
        for line in lines:
            self._show(line.removesuffix("\r"))

    def flush(self) -> None:
        """Show what has come behind the last line's end."""
        rest = self._rest + self._decoder.decode(b"", final=True)
        self._rest = ""
        self._decoder.reset()
        if rest:
            self._show(rest)
