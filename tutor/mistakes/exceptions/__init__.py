"""Exceptions as mistakes of the catalogue: the tables of known ones, and the page of all others."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import OutputLine, Trace
from tutor.judge.tracebacks import Traceback, last_traceback
from tutor.mistakes.entry import CATALOGUE, EVERY_SYMPTOM, Case, Catalogue, Evidence, Found, Mistake
from tutor.mistakes.exceptions.known import KnownException
from tutor.mistakes.exceptions.matching import RaisedException, recognise
from tutor.mistakes.exceptions.table import load, parse

__all__ = ["KnownException", "RaisedException", "add_table", "load", "parse", "raised_in", "recognise"]

_EXPLAINED = tuple(symptom for symptom in EVERY_SYMPTOM if symptom is not Symptom.BAD_VALUE_ACCEPTED)
"""A bad value that is accepted and then raises an exception was accepted in the first place."""

_UNSAID = object()

_ORDER = ("launch", "parameters", "attributes", "calls", "messages", "process", "imports", "python")


def add_table(catalogue: Catalogue, path: Path, *, validate: bool = False) -> None:
    """Add the known exceptions of a table (TOML) to a catalogue. Raises TableError if the table is not valid."""
    for known in load(path, validate=validate):
        find = partial(_find, known)
        catalogue.entries[known.id] = Mistake(
            known.id,
            "{says}",
            "{do}",
            frozenset(_EXPLAINED),
            Evidence.PROCESS,
            find,
            known.page,
            known.slip,
            name=known.name,
        )


def _find(known: KnownException, case: Case) -> Iterator[Found]:
    for seen in raised_in(case):
        for way in known.ways:
            # An exception that the program itself raises because of another one says less than that other one, so
            # ways for any type only apply to the origin.
            if way.type == ".*" and seen.traceback.follows is not None:
                continue
            if (found := recognise(way, seen)) is not None:
                place = f" ({found.file}, line {found.line})" if found.line else ""
                words = {**found.words, "says": f"{seen.raised}{place}: {found.words['says']}"}
                yield Found(words, found.file, found.line, found.code)


def raised_in(case: Case) -> list[RaisedException]:
    """The exceptions of the last traceback's chain, the likeliest root first; none if the program wrote none.

    A criterion that says what was `raised` (a Traceback or None) knows better, such as in a launch of many programs.

    The origin comes first; if the program handles it, and a call in its handler fails, the last exception does.
    """
    last = case.about("raised", _UNSAID)
    if last is _UNSAID:
        last = last_traceback(case.trace)
    if last is None:
        return []
    chain = [last]
    while (before := chain[-1].follows) is not None:
        chain.append(before)
    if not _fails_in_handler(last, case):
        chain.reverse()
    return [_read(each, last, case) for each in chain]


def _read(raised: Traceback, last: Traceback, case: Case) -> RaisedException:
    folder, sources = case.trace.folder, case.trace.sources
    own = raised.own(folder) or last.own(folder)
    file = own.name if own and own.name in sources else case.trace.file
    after = "" if raised is last else f"; then {last.raised}"
    return RaisedException(raised, folder, own, file, sources.get(file, ""), after)


def _fails_in_handler(raised: Traceback, case: Case) -> bool:
    """Whether the exception comes from a statement of the learner's exception handler other than a `raise`."""
    own = raised.own(case.trace.folder)
    if raised.follows is None or own is None:
        return False
    file = case.program.named(own.name)
    statement = file.statement_at(own.line)
    return (
        statement is not None
        and not isinstance(statement, ast.Raise)
        and any(isinstance(around, ast.ExceptHandler) for around in file.ancestors(statement))
    )


for _name in _ORDER:
    if (_path := Path(__file__).parent / f"{_name}.toml").exists():
        add_table(CATALOGUE, _path)


@CATALOGUE.mistake(
    "unhandled-exception",
    explains=_EXPLAINED,
    evidence=Evidence.PROCESS,
    says="{says}",
    do="{do}",
    example=lambda source: example_of(source),
)
def unhandled_exception(case: Case) -> Iterator[Found]:
    """An exception that nothing catches.

    Python stops the callback, and with it the spin and the program, at the line that raised it. The last line of the
    traceback says what Python could not do; the line of yours above it is where to look.

    Bad:

        def ring(self):
            self.bell.play(self.tunes['doorbell'])

    Good:

        def ring(self):
            self.bell.play(self.tunes.get('doorbell', 'ding'))

    See it: the log in the app, or the terminal in which the node ran.
    """
    for seen in raised_in(case)[:1]:
        own = seen.line
        if own is None:
            says = seen.raised
            do = "Find the line of yours that leads to it in the last lines of the output."
            yield Found({"says": says, "do": do})
        else:
            do = f"Look at line {own.line} of {own.name}: what Python says about it is the last line of the traceback."
            yield Found({"says": f"{seen.raised} ({own})", "do": do}, own.name, own.line, own.code)


def example_of(source: str) -> Observation:
    number = len(source.splitlines())
    lines = [
        "Traceback (most recent call last):",
        f'  File "/ws/node.py", line {number}, in ring',
        f"    {source.splitlines()[-1].strip()}",
        "KeyError: 'doorbell'",
    ]
    output = tuple(OutputLine("stderr", line, 0.0) for line in lines)
    return Symptom.ENDED.seen(Trace("node.py", "/ws", sources={"node.py": source}, output=output))
