"""The commands typed so far, as a shell remembers them."""

from __future__ import annotations

from collections.abc import Iterable

LONGEST = 500


class History:
    """Steps through earlier commands; what was being typed comes back below the newest one."""

    def __init__(self, entries: Iterable[str] = ()) -> None:
        self.entries = list(entries)[-LONGEST:]
        self._place = len(self.entries)
        self._draft = ""

    def add(self, command: str) -> None:
        """Remember a command; one that was just typed before is not kept twice."""
        if self.entries[-1:] != [command]:
            self.entries = [*self.entries, command][-LONGEST:]
        self._place, self._draft = len(self.entries), ""

    def older(self, shown: str) -> str:
        """The command before the one that is shown."""
        if self._place == len(self.entries):
            self._draft = shown
        self._place = max(0, self._place - 1)
        return self.entries[self._place] if self.entries else shown

    def newer(self, shown: str) -> str:
        """The command after the one that is shown; at the end, what was being typed."""
        if self._place >= len(self.entries):
            return shown
        self._place += 1
        return self.entries[self._place] if self._place < len(self.entries) else self._draft
