"""The commands typed so far, as a shell remembers them."""

from __future__ import annotations

from collections.abc import Iterable

MAX_ENTRIES = 500


class History:
    """Steps through earlier commands; the unfinished line (draft) comes back after the newest one."""

    def __init__(self, entries: Iterable[str] = ()) -> None:
        self.entries = list(entries)[-MAX_ENTRIES:]
        self._index = len(self.entries)
        self._draft = ""

    def add(self, command: str) -> None:
        """Append a command, unless it repeats the last one, and step back to the end."""
        if self.entries[-1:] != [command]:
            self.entries = [*self.entries, command][-MAX_ENTRIES:]
        self._index, self._draft = len(self.entries), ""

    def older(self, shown: str) -> str:
        """Return the command before the one shown."""
        if self._index == len(self.entries):
            self._draft = shown
        self._index = max(0, self._index - 1)
        return self.entries[self._index] if self.entries else shown

    def newer(self, shown: str) -> str:
        """Return the command after the one shown or, at the end, the draft."""
        if self._index >= len(self.entries):
            return shown
        self._index += 1
        return self.entries[self._index] if self._index < len(self.entries) else self._draft
