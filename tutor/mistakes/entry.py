"""What an entry of the catalogue is, and what it is asked about."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cached_property
from typing import Any

from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame, Traceback, last_traceback
from tutor.mistakes.raised_exceptions import RaisedException, exceptions_of
from tutor.source import NodeFile, Program, SourceFile

EVERY_SYMPTOM = tuple(Symptom)


class Evidence(IntEnum):
    """What shows a mistake, the surest first; entries are asked in this order.

    `PROCESS`: how the process ended, a traceback. `RUN`: the graph, the log, a stack dump, what else was observed.
    `SOURCE`: the learner's code. `SYMPTOM`: nothing but the symptom itself.
    """

    PROCESS = 0
    RUN = 1
    SOURCE = 2
    SYMPTOM = 3


@dataclass(frozen=True)
class Case:
    """One observation, with the learner's program read: what the entries are asked about."""

    seen: Observation

    @property
    def symptom(self) -> Symptom:
        """What the criterion saw."""
        return self.seen.symptom

    @property
    def trace(self) -> Trace:
        """The run in which it was seen."""
        return self.seen.trace

    @property
    def stuck(self) -> tuple[Frame, ...]:
        """A stack dump of the node's threads while it answered nothing, innermost frame first; often empty."""
        return self.seen.stuck

    @property
    def answers(self) -> bool:
        """Whether the node has answered a request in this run."""
        return self.seen.answers

    def about(self, name: str, default: Any = None) -> Any:
        """What else was seen, such as "topic"; `default` if the criterion does not say."""
        return self.seen.about.get(name, default)

    @property
    def passed(self) -> bool:
        """Whether everything passed: nothing went wrong, and only a remark is asked for."""
        return bool(self.about("passed"))

    @cached_property
    def program(self) -> Program:
        """All files of the learner's program."""
        return Program(self.trace.sources, self.trace.file)

    @property
    def file(self) -> NodeFile:
        """The file that was run."""
        return self.program.file

    @property
    def files(self) -> tuple[NodeFile, ...]:
        """The file that was run, then those that it imports."""
        return self.program.files

    @cached_property
    def exceptions(self) -> tuple[RaisedException, ...]:
        """The exceptions of the last traceback that the program wrote, the likeliest root first; often none.

        A criterion that says what was `raised` (a Traceback or None) knows better, as in a launch of many programs.
        """
        told: Traceback | None = self.about("raised")
        last = told if "raised" in self.seen.about else last_traceback(self.trace)
        return exceptions_of(last, self.program, self.trace.folder)

    def place(self, name: str, line: int) -> str:
        """A line of a file, for use in a sentence: "line 12", or "helper.py, line 12"."""
        is_clear = not name or (name == self.trace.file and len(self.trace.sources) < 2)
        return f"line {line}" if is_clear else f"{name}, line {line}"

    @property
    def nodes(self) -> str:
        """The nodes' names, for use in a sentence: "the node /talker"."""
        names = list(dict.fromkeys(self.trace.graph.nodes))
        return f"the node {', '.join(names)}" if names else "the node"


@dataclass(frozen=True)
class Found:
    """One occurrence of a mistake: its place, if it has one, and words for the placeholders of `says` and `do`."""

    words: dict[str, object] = field(default_factory=dict)
    file: str = ""
    line: int = 0
    code: str = ""


def found(file: SourceFile, node: ast.AST, /, **words: object) -> Found:
    """A mistake at a node of a file's syntax tree."""
    line = getattr(node, "lineno", 0)
    return Found(words, file.name, line, file.line(line))


def found_at(frame: Frame | None, /, **words: object) -> Found:
    """A mistake at a frame of a traceback or stack dump; without a place if there is none."""
    return Found(words, frame.name, frame.line, frame.code) if frame is not None else Found(words)


Find = Callable[[Case], Iterable[Found]]


@dataclass(frozen=True)
class Mistake:
    """One mistake of the catalogue.

    `id`: stable, in words joined by hyphens. `says`: what is wrong, in one or two sentences; `do`: the next step, in
    one sentence. Both have placeholders: `{line}` ("line 12", or "helper.py, line 12"), `{code}` (that line), and the
    words of what was found. `explains`: the symptoms for which it is asked. `find`: yields its occurrences; its
    docstring is the page. `slip`: a misspelled name, missing parentheses and the like, whose step may hold one line of
    code. `remark`: what to say of it where everything passed, after its file and line (see `Case.passed`); "" if it is
    no remark. `example`: the observation in which the page's bad example is found, if its source alone does not show
    it.
    """

    id: str
    says: str
    do: str
    explains: frozenset[Symptom]
    evidence: Evidence
    find: Find
    page: str
    slip: bool = False
    remark: str = ""
    name: str = ""
    example: Callable[[str], Observation] | None = None

    @property
    def title(self) -> str:
        """What it is called in a report: the id in words, unless it has a name of its own."""
        return self.name or self.id.replace("-", " ")

    @property
    def summary(self) -> str:
        """The first line of its page."""
        return self.page.partition("\n")[0]

    @property
    def examples(self) -> tuple[tuple[str, str], ...]:
        """The blocks of code under "Bad:" and "Good:" of the page."""
        blocks = re.findall(r"^Bad:\n\n((?: {4}.*\n|\n)+?)\nGood:\n\n((?: {4}.*\n?|\n)+)", self.page + "\n", re.M)
        return tuple((textwrap.dedent(bad).strip("\n"), textwrap.dedent(good).strip("\n")) for bad, good in blocks)


class Catalogue:
    """Mistakes in the order in which they are asked, apart from their evidence."""

    def __init__(self) -> None:
        self.entries: dict[str, Mistake] = {}

    def mistake(
        self,
        id: str,
        *,
        explains: Iterable[Symptom],
        says: str,
        do: str,
        evidence: Evidence = Evidence.SOURCE,
        slip: bool = False,
        remark: str = "",
        name: str = "",
        example: Callable[[str], Observation] | None = None,
    ) -> Callable[[Find], Find]:
        """Register a function that finds a mistake; its docstring is the page of `ros-tutor explain ID`."""

        def register(find: Find) -> Find:
            if id in self.entries:
                raise ValueError(f"there are two mistakes called {id}")
            page = inspect.cleandoc(find.__doc__ or "")
            self.entries[id] = Mistake(
                id, says, do, frozenset(explains), evidence, find, page, slip, remark, name, example
            )
            return find

        return register


CATALOGUE = Catalogue()
"""The mistakes that ros-tutor knows, whatever the exercise."""

mistake = CATALOGUE.mistake
