"""A criterion as a function: a short script against the running node, for what no form covers."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Coroutine, Mapping
from contextlib import AsyncExitStack
from dataclasses import dataclass, replace
from typing import Any

from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Parameter, Program, Topic, Value
from tutor.exercise.running_node import Node, Unmet
from tutor.exercise.seen_run import slowed_so_far
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.verdict import Verdict, passed

Script = Callable[[Node], Coroutine[Any, Any, None]]


@dataclass(frozen=True)
class ScriptRun:
    """What a script found. `slowed`: see `tutor.judge.bench.was_slowed`."""

    verdict: Verdict
    slowed: bool


@dataclass(frozen=True)
class RunScript:
    """Start the program, and run a script against it."""

    program: Program
    script: Script
    expected: str
    parameters: tuple[tuple[Parameter, Value], ...]
    watch: tuple[Topic, ...]

    async def __call__(self, bench: Bench) -> ScriptRun:
        given = {parameter.name: value for parameter, value in self.parameters}
        watched = {topic.name: topic.type for topic in self.watch}
        async with (
            bench.start(self.program.file, parameters=given, watch=watched) as run,
            AsyncExitStack() as ours,
        ):
            node = Node(bench, run, self.program, self.expected, self.watch, ours)
            try:
                await self.script(node)
                verdict = passed(self.expected, node.seen[-1] if node.seen else "it does", node.seen)
            except Unmet as unmet:
                verdict = replace(unmet.verdict, expected=self.expected)
            return ScriptRun(verdict, slowed_so_far(run))


@dataclass(frozen=True)
class Scripted(Form):
    """A criterion that a function judges; see `criterion`."""

    expected: str
    script: Script
    parameters: Mapping[Parameter, Value]
    watch: tuple[Topic, ...]

    def criterion(self, exercise: Exercise) -> Criterion:
        scenario = RunScript(exercise.program, self.script, self.expected, tuple(self.parameters.items()), self.watch)
        return self.judged(lambda seen: seen.verdict, scenario)


def criterion(
    id: str,
    expected: str,
    *,
    parameters: Mapping[Parameter, Value] | None = None,
    watch: tuple[Topic, ...] = (),
    after: Form | tuple[Form, ...] = (),
    bonus: bool = False,
) -> Callable[[Script], Scripted]:
    """Make a criterion of a function, which is then listed in the check like one of the other forms.

    `id`, `after` and `bonus`: see `Form`. `expected`: what must be seen, in words. `parameters`: those that the program
    is started with. `watch`: the topics that the function looks at. The function gets the running `Node`:

        @criterion("push", "success=true, and the count goes up by one", watch=(COUNT,), after=counts)
        async def push(node: Node) -> None:
            answer = await node.call(PUSH)
            node.expect(answer.success, True, do="Set success in the response.")
            shown = await node.next(COUNT, after=answer)
            node.expect(shown.data, 1, do="Publish what the callback has counted.")

    A missing service, no answer, a wrong type and a slow machine are the node's business. Each function has a start of
    the program to itself. On a busy machine, the whole function is run once more, on another start, before it may fail
    the criterion. Raises ValueError if an `await` was forgotten.
    """

    def make(script: Script) -> Scripted:
        reject_forgotten_awaits(script)
        return Scripted(id, expected, script, parameters or {}, watch, after=after, bonus=bonus)

    return make


def reject_forgotten_awaits(script: Script) -> None:
    """Raise ValueError if the function calls something of the node's that is to be awaited, and does not.

    Python would only warn, and whatever it should have judged would pass.
    """
    tree = ast.parse(textwrap.dedent(inspect.getsource(script)))
    first_line = script.__code__.co_firstlineno
    for statement in ast.walk(tree):
        if not isinstance(statement, ast.Expr) or not isinstance(statement.value, ast.Call):
            continue
        called = statement.value.func
        if isinstance(called, ast.Attribute) and inspect.iscoroutinefunction(getattr(Node, called.attr, None)):
            line = first_line + statement.lineno - 1
            raise ValueError(f"line {line} awaits nothing: write `await {ast.unparse(called)}(...)`")
