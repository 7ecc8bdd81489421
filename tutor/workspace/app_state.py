"""What the terminal app remembers from one time to the next: where the learner was, and how they like it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from datetime import UTC, datetime
from pathlib import Path

from tutor.errors import StorageError
from tutor.json_codec import read_as, read_document, write_document
from tutor.workspace.atomic import write_atomically
from tutor.workspace.regular import read_text

SCHEMA = "ros-tutor/app/1"


@dataclass(frozen=True, slots=True)
class RunOptions:
    """How the learner wants their node run: lines `name:=value`, and lines `from:=to` for remapped names.

    For a launch file `parameters` are its launch arguments.
    """

    parameters: tuple[str, ...] = ()
    remaps: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class AppState:
    """What is remembered. Empty texts mean: nothing yet. `runs` has the run options of each exercise.

    `first_failure`: a check ends at its first failure.
    """

    lesson: str = ""
    page: str = ""
    theme: str = ""
    lessons_shown: bool = True
    zoomed: bool = False
    check_on_save: bool = False
    first_failure: bool = False
    restart_on_save: bool = False
    side_by_side: bool = True
    runs: Mapping[str, RunOptions] = field(default_factory=dict)

    def run_of(self, exercise: str) -> RunOptions:
        """The run options of one exercise; empty ones where there are none."""
        return self.runs.get(exercise, RunOptions())

    def with_run(self, exercise: str, options: RunOptions) -> AppState:
        """A copy in which `exercise` is run with these options."""
        return replace(self, runs={**self.runs, exercise: options})


def encode(state: AppState) -> str:
    """Write the state as JSON."""
    return write_document(SCHEMA, **{each.name: getattr(state, each.name) for each in fields(state)})


def decode(text: str) -> AppState:
    """Read what `encode` wrote. Raises ValueError, which says what is wrong."""
    return read_as(AppState, read_document(text, SCHEMA))


class AppStateFile:
    """The state of one workspace's app. The last writer wins: two apps at once do no harm."""

    def __init__(self, path: Path, notify: Callable[[str], None]) -> None:
        self.path = path
        self._notify = notify

    def read(self) -> AppState:
        """What is on disk; the defaults where there is nothing. A damaged file is set aside, and `notify` is called."""
        try:
            return decode(read_text(self.path))
        except FileNotFoundError:
            return AppState()
        except OSError as error:
            self._notify(f"what the app remembered cannot be read: {error.strerror or error}")
        except ValueError as error:
            self._set_aside(str(error))
        return AppState()

    def write(self, state: AppState) -> None:
        """Replace it, atomically. Raises StorageError."""
        write_atomically(self.path, encode(state))

    def _set_aside(self, reason: str) -> None:
        aside = self.path.with_name(f"{self.path.name}.damaged-{datetime.now(UTC):%Y%m%dT%H%M%S%fZ}")
        try:
            self.path.rename(aside)
        except OSError as error:
            self._notify(str(StorageError.of(f"rename {self.path}", error)))
            return
        self._notify(f"what the app remembered could not be read ({reason}); the file is kept as {aside}")
