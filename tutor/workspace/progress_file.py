"""The progress file: written atomically, safe across processes, and never lost silently."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tutor.errors import StorageError
from tutor.terminal_text import printable
from tutor.workspace.atomic import write_atomically
from tutor.workspace.damaged import set_aside
from tutor.workspace.locking import lock
from tutor.workspace.progress import Progress, decode, encode
from tutor.workspace.regular import read_text

_LOCK_TIMEOUT_S = 10.0


def to_stderr(message: str) -> None:
    """Print a message for the learner, separately from the report."""
    print(f"ros-tutor: {printable(message)}", file=sys.stderr)


class ProgressFile:
    """The progress file of one workspace. Reading needs no lock, since writes replace the file atomically."""

    def __init__(self, path: Path, notify: Callable[[str], None] = to_stderr) -> None:
        self.path = path
        self._notify = notify

    def read(self) -> Progress:
        """Read the progress; empty if there is no file yet. A damaged file is set aside.

        Raises StorageError if the file cannot be read.
        """
        try:
            return self._load()
        except ValueError:
            pass
        try:
            return self.change(lambda progress: progress)
        except StorageError as error:
            self._notify(f"your progress cannot be read ({self.path} is damaged, and {error})")
            return Progress()

    def change(self, change: Callable[[Progress], Progress]) -> Progress:
        """Read, change and write under a lock, so that no other process's change is lost; return the new progress.

        Raises StorageError.
        """
        with self._locked():
            try:
                before = self._load()
            except ValueError as reason:
                self._set_aside(str(reason))
                before = Progress()
            after = change(before)
            if after != before or not self.path.exists():
                write_atomically(self.path, encode(after))
            return after

    def next_hint(self, exercise: str, total: int) -> tuple[int, bool]:
        """Count one more of the exercise's `total` hints as shown.

        Returns its number, from 1, and whether it was shown before: the last hint is repeated.
        """
        shown_before = 0

        def count(progress: Progress) -> Progress:
            nonlocal shown_before
            shown_before = progress.of(exercise).hints
            return progress.with_hints(exercise, min(shown_before + 1, total))

        self.change(count)
        return min(shown_before + 1, total), shown_before >= total

    def _load(self) -> Progress:
        try:
            return decode(read_text(self.path))
        except FileNotFoundError:
            return Progress()
        except OSError as error:
            raise StorageError.of(f"read {self.path}", error) from error

    def _set_aside(self, reason: str) -> None:
        aside = set_aside(self.path)
        self._notify(
            f"your progress could not be read ({reason}); a new file is started, the old one is kept as {aside}"
        )

    @contextmanager
    def _locked(self) -> Iterator[None]:
        """Hold the lock, which is on a separate file, because each write replaces the progress file itself."""
        file = self.path.with_suffix(".lock")
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            handle = os.open(file, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        except OSError as error:
            raise StorageError.of(f"write to {file.parent}", error) from error
        try:
            self._lock(handle)
            self._remove_leftovers()
            yield
        finally:
            os.close(handle)

    def _lock(self, handle: int) -> None:
        try:
            locked = lock(handle, _LOCK_TIMEOUT_S)
        except OSError as error:
            raise StorageError.of(f"lock {self.path}", error) from error
        if not locked:
            raise StorageError(
                f"cannot write {self.path}: another ros-tutor has kept it locked for {_LOCK_TIMEOUT_S:.0f} s"
            )

    def _remove_leftovers(self) -> None:
        """Remove temporary files of killed writers: while we hold the lock, nobody else is writing."""
        for leftover in self.path.parent.glob(f".{self.path.name}.*.tmp"):
            leftover.unlink(missing_ok=True)
