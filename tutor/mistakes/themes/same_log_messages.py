"""Log messages that say the same whether or not something went wrong."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import LogRecord
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run


@mistake(
    "the-same-message-for-every-call",
    explains=[Symptom.NOT_LOGGED],
    evidence=Evidence.RUN,
    says="a valid division is logged in the same words as one by zero, so the message reports no error: {message}",
    do="Log the error only when b is 0.",
    example=in_run(
        Symptom.NOT_LOGGED,
        ordinary=(LogRecord(40, "node", "error", 0.0, 0.0),),
        logged=(LogRecord(40, "node", "error", 0.0, 0.0),),
        recognise=re.compile("error").search,
    ),
)
def same_message(case: Case) -> Iterator[Found]:
    """The same message appears whether or not something went wrong.

    A message reports an error only if it does not also appear when all is well. Otherwise, whoever reads the log cannot
    tell the two apart.

    Bad:

        self.get_logger().error('door open, or door stuck')

    Good:

        self.get_logger().error('door stuck')

    See it: the log, after a call that works.
    """
    recognise = case.about("recognise")
    usual = [log.text for log in case.about("ordinary", ()) if log.level >= 30 or recognise(log.text)]
    if usual and case.about("logged"):
        yield Found({"message": usual[-1]})
