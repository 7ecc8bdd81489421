"""Modules that a file of the learner's own hides."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found_at, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.exceptions import EXPLAINED_WHILE_RUNNING

_MISSING = re.compile(r"^(?:partially initialized )?module '(?P<module>\w+)' has no attribute '(?P<name>\w+)'")
_NOT_IMPORTED = re.compile(
    r"^cannot import name '(?P<name>\w+)' from (?:partially initialized module )?'(?P<module>\w+)'"
)
_EXAMPLE = (
    "Traceback (most recent call last):",
    '  File "/ws/node.py", line 2, in <module>',
    "    bell = random.choice(['ding', 'dong'])",
    "AttributeError: module 'random' has no attribute 'choice'",
)


@mistake(
    "file-hides-a-module",
    name="own file hides a module",
    explains=EXPLAINED_WHILE_RUNNING,
    evidence=Evidence.PROCESS,
    says="{module} is your file {module}.py here, which has no {name}, and not the module of that name: {code}",
    do="Give your file {module}.py another name.",
    example=in_run(Symptom.ENDED, output=_EXAMPLE, files={"random.py": ""}),
)
def hidden_module(case: Case) -> Iterator[Found]:
    """A file of your own has the name of a module.

    Python looks for a module beside the program first. A file random.py, or an old rclpy.py, in that folder is imported
    in place of the real one, by every import in the program.

    Bad:

        import random
        bell = random.choice(['ding', 'dong'])

    Good:

        import random
        bell = random.choice(['ding', 'dong'])

    See it: print(random.__file__). The code is right; the file beside it is in the way.
    """
    for raised in case.exceptions:
        matched = _MISSING.search(raised.traceback.message) or _NOT_IMPORTED.search(raised.traceback.message)
        if matched and f"{matched['module']}.py" in case.trace.sources and f"{matched['module']}.py" != case.trace.file:
            yield found_at(raised.line, module=matched["module"], name=matched["name"])
