"""The last whole check of each exercise with all it found, kept so that the app can show it again after a restart."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from tutor.errors import StorageError
from tutor.json_codec import convert_to, read_document, write_document
from tutor.judge.result import ExerciseResult
from tutor.workspace.atomic import write_atomically
from tutor.workspace.damaged import set_aside
from tutor.workspace.progress import Progress
from tutor.workspace.regular import read_text

SCHEMA, FORMER_SCHEMA = "ros-tutor/last-check/2", "ros-tutor/last-check/1"
"""In the former one, the steps were changes to the code, under another name, and no mistake had an id."""


@dataclass(frozen=True, slots=True)
class LastCheck:
    """What a check of every criterion of one exercise found, and when: `at` is a UTC time in ISO 8601."""

    at: str
    result: ExerciseResult

    def is_current(self, progress: Progress) -> bool:
        """Return whether no later check of every criterion is in the progress: its findings were not kept, then."""
        whole = [attempt.at for attempt in progress.of(self.result.id).attempts if attempt.whole]
        return not whole or self.at >= whole[-1]


def encode(last: LastCheck) -> str:
    """Encode a check as JSON."""
    return write_document(SCHEMA, at=last.at, result=last.result)


def decode(text: str) -> LastCheck:
    """Decode the output of `encode`. Raises ValueError with a description of the problem.

    A check of the former schema is read without its steps.
    """
    return convert_to(LastCheck, read_document(text, SCHEMA, FORMER_SCHEMA))


class LastChecks:
    """One file for each exercise, in one folder. If two processes write the same one, the last one wins."""

    def __init__(self, folder: Path, notify: Callable[[str], None]) -> None:
        self.folder = folder
        self._notify = notify

    def path_of(self, exercise: str) -> Path:
        """Return the path of the file of an exercise."""
        return self.folder / f"{exercise}.json"

    def read(self, exercises: Iterable[str]) -> dict[str, LastCheck]:
        """Read the last checks of these exercises, by id. A damaged file is set aside, and `notify` is called."""
        found = {exercise: self._read(exercise) for exercise in exercises}
        return {exercise: last for exercise, last in found.items() if last is not None}

    def _read(self, exercise: str) -> LastCheck | None:
        path = self.path_of(exercise)
        try:
            last = decode(read_text(path))
            if last.result.id != exercise:
                raise ValueError("it is of another exercise")
        except FileNotFoundError:
            return None
        except OSError as error:
            self._notify(f"the last check of {exercise} cannot be read: {error.strerror or error}")
            return None
        except ValueError as error:
            self._set_aside(path, f"the last check of {exercise} could not be read ({error})")
            return None
        return last

    def write(self, last: LastCheck) -> None:
        """Replace the file of the exercise atomically. Raises StorageError."""
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StorageError.of(f"make {self.folder}", error) from error
        write_atomically(self.path_of(last.result.id), encode(last))

    def _set_aside(self, path: Path, problem: str) -> None:
        try:
            self._notify(f"{problem}; the file is kept as {set_aside(path)}")
        except StorageError as error:
            self._notify(str(error))
