"""Files of an exercise that are not there."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run


@mistake(
    "client-file-missing",
    name="file missing",
    explains=[Symptom.CALLS_MISSING],
    evidence=Evidence.PROCESS,
    says="there is no {file} among the files",
    do="Write the client in {file}, next to {beside}.",
    example=in_run(Symptom.CALLS_MISSING, file="bell_client.py", beside="bell_server.py"),
)
def file_missing(case: Case) -> Iterator[Found]:
    """One of the files is not there.

    An exercise with two programs has two files, each of which is started by its name.

    Bad:

        # bell_client.py is still to be written

    Good:

        # bell_client.py
        bell = node.create_client(Trigger, 'ring')

    See it: `ls`.
    """
    if case.about("file"):
        yield Found({"file": case.about("file"), "beside": case.about("beside")})
