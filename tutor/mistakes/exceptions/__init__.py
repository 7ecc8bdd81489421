"""Exceptions as mistakes of the catalogue: the tables of known ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import OutputLine, Trace
from tutor.mistakes.entry import CATALOGUE, EVERY_SYMPTOM, Case, Catalogue, Evidence, Found, Mistake
from tutor.mistakes.exceptions.known import Example, KnownException
from tutor.mistakes.exceptions.matching import recognise
from tutor.mistakes.exceptions.table import load, parse
from tutor.mistakes.raised_exceptions import RaisedException

__all__ = [
    "EXPLAINED",
    "EXPLAINED_WHILE_RUNNING",
    "KnownException",
    "RaisedException",
    "add",
    "add_table",
    "found_in",
    "from_example",
    "load",
    "parse",
    "raised_in",
    "recognise_any",
]

EXPLAINED = frozenset(EVERY_SYMPTOM) - {Symptom.BAD_VALUE_ACCEPTED}
"""A bad value that is accepted and then raises an exception was accepted in the first place."""

EXPLAINED_WHILE_RUNNING = EXPLAINED - {Symptom.DOES_NOT_END, Symptom.ENDS_BADLY}
"""What Ctrl+C raises while a program ends has entries of its own."""

_MAX_CODE = 80
"""Length to which a line of code is cut."""

_known: list[KnownException] = []
"""All known exceptions of our own catalogue, in the order in which they are asked."""


def add_table(catalogue: Catalogue, path: Path, *, validate: bool = False) -> None:
    """Add the known exceptions of a table (TOML) to a catalogue. Raises TableError if the table is not valid."""
    for known in load(path, validate=validate):
        add(catalogue, known)
        if catalogue is CATALOGUE:
            _known.append(known)


def add(catalogue: Catalogue, known: KnownException) -> None:
    """Add one known exception to a catalogue; its first example becomes that of its page."""
    if known.id in catalogue.entries:
        raise ValueError(f"there are two mistakes called {known.id}")
    first = next((example for way in known.ways for example in way.examples), Example("Exception"))
    catalogue.entries[known.id] = Mistake(
        known.id,
        "{says}",
        "{do}",
        EXPLAINED_WHILE_RUNNING if known.while_running else EXPLAINED,
        Evidence.PROCESS,
        partial(_find, known),
        known.page,
        known.slip,
        name=known.name,
        example=from_example(first),
    )


def _find(known: KnownException, case: Case) -> Iterator[Found]:
    for place, seen in enumerate(case.exceptions):
        if (told := _recognised(known, seen)) is None:
            continue
        # Another entry that knows an exception nearer to the root knows better.
        if not any(recognise_any(nearer) for nearer in case.exceptions[:place]):
            yield found_in(seen, told)


def recognise_any(seen: RaisedException) -> Found | None:
    """The first mistake of our own tables that an exception shows; its words are `says` and `do`."""
    return next((told for known in _known if (told := _recognised(known, seen)) is not None), None)


def _recognised(known: KnownException, seen: RaisedException) -> Found | None:
    for way in known.ways:
        # An exception that the program itself raises because of another one says less than that other one, so ways
        # for any type only apply to the origin.
        if way.type.endswith(".*") and seen.traceback.follows is not None:
            continue
        if (told := recognise(way, seen)) is not None:
            return told
    return None


def found_in(seen: RaisedException, told: Found | None = None, /, **words: object) -> Found:
    """A mistake that an exception shows, with the word `raised`: the exception and its place.

    `told`: with another place than the learner's line in the traceback; its word `says` follows the exception.
    """
    if told is None:
        line = seen.line
        told = Found({}, line.name, line.line, line.code) if line is not None else Found({}, seen.file)
    code = told.code if len(told.code) <= _MAX_CODE else f"{told.code[: _MAX_CODE - 3]}..."
    place = f" ({told.file}, line {told.line}{': ' + code if code else ''})" if told.line else ""
    raised = f"{seen.raised}{place}"
    more: dict[str, object] = {**told.words, **words, "raised": raised}
    if "says" in more:
        more["says"] = f"{raised}: {more['says']}"
    return Found(more, told.file, told.line, told.code)


def raised_in(case: Case) -> tuple[RaisedException, ...]:
    """The exceptions of the last traceback's chain, the likeliest root first; none if the program wrote none."""
    return case.exceptions


def from_example(example: Example) -> Callable[[str], Observation]:
    """A function that makes the observation in which an example's exception was raised, whatever the page's source.

    The example is the file "node.py" in the folder "/ws"; without a source of its own, the line is all of it.
    """

    def observe(source: str) -> Observation:
        text = example.source or example.line
        lines = [line.strip() for line in text.splitlines()]
        number = lines.index(example.line) + 1 if example.line in lines else 1
        written = ["Traceback (most recent call last):"]
        if example.line:
            written += [f'  File "/ws/node.py", line {number}, in {example.function}', f"    {example.line}"]
        if example.at:
            path, _, function = example.at.partition(", ")
            written.append(f'  File "{path}", line 75, in {function}')
        if len(written) == 1:
            written.append('  File "/lib/threading.py", line 75, in run')
        output = tuple(OutputLine("stderr", line, 0.0) for line in (*written, example.raised))
        return Symptom.ENDED.seen(Trace("node.py", "/ws", sources={"node.py": text}, output=output))

    return observe
