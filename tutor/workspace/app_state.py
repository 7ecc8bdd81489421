"""The terminal app's persistent state: where the learner was, and their preferences."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path

from tutor.errors import StorageError
from tutor.json_codec import convert_to, read_document, write_document
from tutor.workspace.atomic import write_atomically
from tutor.workspace.damaged import set_aside
from tutor.workspace.regular import read_text

SCHEMA = "ros-tutor/app/1"


@dataclass(frozen=True, slots=True)
class RunOptions:
    """How the learner wants their node run: parameters as lines `name:=value`, remaps as lines `from:=to`.

    For a launch file, `parameters` are its launch arguments.
    """

    parameters: tuple[str, ...] = ()
    remaps: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class AppState:
    """The saved state. An empty text means that nothing was saved yet. `runs` maps exercise ids to run options.

    `first_failure`: a check ends at its first failure. `explained`: the mistakes whose page was opened unasked, each
    after the id of the exercise, as in "i2.1 old-timer-kept".
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
    explained: tuple[str, ...] = ()

    def run_of(self, exercise: str) -> RunOptions:
        """Return the run options of one exercise; empty if there are none."""
        return self.runs.get(exercise, RunOptions())

    def with_run(self, exercise: str, options: RunOptions) -> AppState:
        """Return a copy in which `exercise` has these run options."""
        return replace(self, runs={**self.runs, exercise: options})


def encode(state: AppState) -> str:
    """Encode the state as JSON."""
    return write_document(SCHEMA, **{attribute.name: getattr(state, attribute.name) for attribute in fields(state)})


def decode(text: str) -> AppState:
    """Decode the output of `encode`. Raises ValueError with a description of the problem."""
    return convert_to(AppState, read_document(text, SCHEMA))


class AppStateFile:
    """The file with the app's state in one workspace. If two apps write it, the last one wins, which does no harm."""

    def __init__(self, path: Path, notify: Callable[[str], None]) -> None:
        self.path = path
        self._notify = notify

    def read(self) -> AppState:
        """Read the state; the defaults if there is no file. A damaged file is set aside, and `notify` is called."""
        try:
            return decode(read_text(self.path))
        except FileNotFoundError:
            return AppState()
        except OSError as error:
            self._notify(f"the app's saved state cannot be read: {error.strerror or error}")
        except ValueError as error:
            self._set_aside(str(error))
        return AppState()

    def write(self, state: AppState) -> None:
        """Replace the file atomically. Raises StorageError."""
        write_atomically(self.path, encode(state))

    def _set_aside(self, reason: str) -> None:
        try:
            aside = set_aside(self.path)
        except StorageError as error:
            self._notify(str(error))
            return
        self._notify(f"the app's saved state could not be read ({reason}); the file is kept as {aside}")
