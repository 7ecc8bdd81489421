"""The page of all exceptions that no other entry knows: what Python itself says about them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import is_in_folder
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.exceptions import EXPLAINED_WHILE_RUNNING, found_in, from_example, raised_in
from tutor.mistakes.exceptions.known import Example
from tutor.mistakes.raised_exceptions import RaisedException

_STOPPED = "where Python could not go on"


@mistake(
    "unhandled-exception",
    explains=EXPLAINED_WHILE_RUNNING,
    evidence=Evidence.PROCESS,
    slip=True,
    says="{raised}",
    do="{do}",
    example=from_example(Example("KeyError: 'doorbell'", "self.bell.play(self.tunes['doorbell'])")),
)
def unhandled_exception(case: Case) -> Iterator[Found]:
    """Nothing catches an exception.

    An exception stops the callback, and with it the spin and the program, at the line that raised it. The last line of
    the traceback says what Python could not do; the last line of your own above it is where to look.

    Bad:

        def ring(self):
            self.bell.play(self.tunes['doorbell'])

    Good:

        def ring(self):
            self.bell.play(self.tunes.get('doorbell', 'ding'))

    See it: the log in the app, or the terminal in which the node ran.
    """
    for seen in raised_in(case)[:1]:
        if case.symptom is Symptom.NOT_LOGGED and case.trace.exit is None and _is_printed_by_handler(seen):
            return  # it is handled: only the node's log is missing
        if seen.line is None:
            yield found_in(seen, do="Find the line of yours that leads to it in the last lines of the output.")
        else:
            meant = re.search(r"Did you mean: '([\w.]+)'", seen.traceback.message)
            place = f"line {seen.line.line} of {seen.line.name}"
            do = f"Write {meant[1]} in {place}, if that is what you mean." if meant else f"Change {place}, {_STOPPED}."
            yield found_in(seen, do=do)


def _is_printed_by_handler(seen: RaisedException) -> bool:
    """Whether the learner's own code has printed the traceback: it then begins where the exception was caught."""
    first = seen.traceback.frames[0] if seen.traceback.frames else None
    return first is not None and is_in_folder(first.path, seen.folder) and first.function not in ("", "<module>")
