"""A learner's node, as far as next steps rewrite it: its functions, and what the file calls its parts.

Read by its syntax tree. It serves the words of a diagnosis, never a verdict.
"""

from __future__ import annotations

import ast
import textwrap
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

from tutor.judge.edits import (
    Edit,
    add_import,
    append_to_function,
    describe_edits,
    insert_above,
    insert_after,
    insert_below,
    is_already_there,
    replace_lines,
    replace_statement,
)
from tutor.judge.source import Function, SourceFile
from tutor.judge.trace import Trace

_MAKING = ("create_publisher", "create_timer", "declare_parameter", "declare_parameters")


@dataclass(frozen=True)
class NodeFile(SourceFile):
    """One file with one node in it. All that it gives are parts of `tree`, or code."""

    @cached_property
    def name(self) -> str:
        """What the node is called where its publisher, its timer and its parameters are made: usually "self"."""
        of = [ast.unparse(each.func.value) for each in self.calls(*_MAKING) if isinstance(each.func, ast.Attribute)]
        if of:
            return Counter(of).most_common(1)[0][0]
        made = next((kept for call in self.calls("create_node", "Node") if (kept := self.assigned_to(call))), "")
        return made or "self"

    @property
    def holder(self) -> str:
        """What a timer is made an attribute of, where it is none yet."""
        return self.name.partition(".")[0]

    @cached_property
    def setup(self) -> Function | None:
        """The function in which the node is put together: usually `__init__`; None where there is none."""
        first = next((each for each in self.calls("create_node", "Node") if self.assigned_to(each) == self.name), None)
        if first is not None:
            return self.function_around(first)
        made = [each for each in self.calls(*_MAKING) if self.function_around(each) is not None]
        inits = [each for each in self.functions if each.name == "__init__" and self.class_of(each) is not None]
        if inits and (self.name.startswith("self") or not made):
            return next((each for each in inits if any(self.function_around(call) is each for call in made)), inits[0])
        return self.function_around(made[0]) if made else None

    @cached_property
    def timers(self) -> list[ast.Call]:
        """Where timers are made."""
        return self.calls("create_timer")

    @cached_property
    def first_timer(self) -> ast.Call | None:
        """Where the timer is made to begin with: in what the set-up leads to, if that makes one."""
        first = [each for each in self.timers if self.setup and self.function_around(each) in self.reached(self.setup)]
        return next(iter(first or self.timers), None)

    @cached_property
    def tick(self) -> Function | None:
        """The function that the timer calls; without a timer, the one that publishes."""
        made = [self.first_timer] if self.first_timer else []
        named = [found for each in made if (found := self.function(argument(each, 1, "callback"))) is not None]
        sending = [found for each in self.calls("publish") if (found := self.function_around(each)) is not None]
        return next(iter([*named, *sending]), None)

    @cached_property
    def publisher(self) -> str:
        """What the publisher is called; empty where there is none."""
        made = (self.assigned_to(each) for each in self.calls("create_publisher", "create_lifecycle_publisher"))
        return next((each for each in made if each), "")

    @property
    def message_class(self) -> str:
        """The class of what is published, as the file calls it."""
        made = next(iter(self.calls("create_publisher", "create_lifecycle_publisher")), None)
        given = argument(made, 0, "msg_type") if made is not None else None
        return ast.unparse(given) if given is not None else ""

    def value(self, parameter: str) -> str:
        """The code that reads a parameter's value."""
        return f"{self.name}.get_parameter({parameter!r}).value"

    def append_to_setup(self, code: str) -> list[Edit]:
        """Code that runs when publisher, timer and parameters are there: below the timer, if the set-up makes one."""
        made = [self.statement(each) for each in self.calls(*_MAKING) if self.function_around(each) is self.setup]
        if made:
            last = max(made, key=lambda each: each.end_lineno or each.lineno)
            return [insert_after(last, code)]
        return [append_to_function(self.setup, code)] if self.setup is not None else []

    def prepend_to(self, function: Function, code: str) -> list[Edit]:
        """Code that a function begins with, below its docstring."""
        first = function.body[0]
        text = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
        if text and len(function.body) > 1:
            first = function.body[1]
        elif text:
            return [insert_after(first, code)]
        if first.lineno == function.lineno:
            return []
        return [insert_above(first_line(first), code)]

    def own(self, name: str, module: str) -> tuple[str, list[Edit]]:
        """How the file calls what it imports from a module, and the import, where that is missing."""
        for each, alias in self.imports:
            if isinstance(each, ast.ImportFrom) and (each.module, alias.name) == (module, name):
                return alias.asname or name, []
            if isinstance(each, ast.ImportFrom) and f"{each.module}.{alias.name}" == module:
                return f"{alias.asname or alias.name}.{name}", []
            if isinstance(each, ast.Import) and alias.name == module:
                return f"{alias.asname or module}.{name}", []
        return name, add_import(self.text, f"from {module} import {name}")

    def new_method(self, code: str) -> list[Edit]:
        """A function of its own: the class's last method, or, for a node without a class, above what uses it."""
        owner = self.class_of(self.setup) if self.setup is not None else None
        if owner is not None:
            like = owner.body[-1]
            return [insert_below(like.end_lineno or like.lineno, "\n" + code, like=first_line(like))]
        return []

    def step(self, *choices: Sequence[Edit] | None) -> str | None:
        """The first of these edits that leaves a file which Python can run, in words; None where there is none.

        The last lines come first: so the numbers of the others stay true for anyone who does one after the other.
        """
        missing = ([edit for edit in each or () if not is_already_there(self.text, edit)] for each in choices)
        tried = (
            describe_edits(self.text, *_from_below(each), file=self.file)
            for each in missing
            if each and self.text.strip()
        )
        return next((words for words in tried if words is not None), None)


def _from_below(edits: Sequence[Edit]) -> list[Edit]:
    """The edits, the last lines first, without those of lines that another one replaces as a whole."""

    def covers(other: Edit, edit: Edit) -> bool:
        if edit.last < edit.first:
            return other.first < edit.first <= other.last
        return other.first <= edit.first and edit.last <= other.last and other != edit

    def covered(edit: Edit) -> bool:
        return any(covers(other, edit) and not covers(edit, other) for other in edits)

    left = [edit for edit in edits if not covered(edit)]
    return sorted(dict.fromkeys(left), key=lambda edit: edit.first, reverse=True)


def argument(call: ast.Call, position: int, name: str) -> ast.expr | None:
    """One argument of a call, given by position or by name; None where it is not there."""
    if len(call.args) > position and not any(isinstance(each, ast.Starred) for each in call.args):
        return call.args[position]
    return next((each.value for each in call.keywords if each.arg == name), None)


def with_body(function: Function, code: str) -> Edit:
    """The lines of a function below its head, and its docstring, with other code; the head too where it must."""
    first = function.body[1 if ast.get_docstring(function) is not None and len(function.body) > 1 else 0]
    end = function.end_lineno or function.lineno
    alone = first.lineno > max(each.lineno for each in (function, *function.args.args))
    if alone and isinstance(function, ast.FunctionDef) and not function.decorator_list:
        return replace_lines(first.lineno, code, end)
    static = "@staticmethod\n" if is_static(function) else ""
    returns = f" -> {ast.unparse(function.returns)}" if function.returns is not None else ""
    head = f"{static}def {function.name}({ast.unparse(function.args)}){returns}:"
    return replace_lines(first_line(function), f"{head}\n{textwrap.indent(code, '    ')}", end)


def is_static(function: Function) -> bool:
    """Whether a method takes no self."""
    return any(ast.unparse(each) == "staticmethod" for each in function.decorator_list)


def rewrite_function(function: Function, code: str, *, given: str = "") -> Edit:
    """The whole function with other lines below its first one; `given`: an argument that it must take."""
    taken, names = ast.unparse(function.args), [each.arg for each in function.args.args]
    if given and given not in names:
        taken = ", ".join([*names[:1], given] if names[:1] in (["self"], ["cls"]) else [given])
    head = f"{'async ' if isinstance(function, ast.AsyncFunctionDef) else ''}def {function.name}({taken})"
    returns = f" -> {ast.unparse(function.returns)}" if function.returns is not None else ""
    lines = [f"{head}{returns}:", *(f"    {line}" for line in code.splitlines())]
    return replace_statement(function, "\n".join(lines))


def first_line(statement: ast.stmt) -> int:
    """The line that a statement begins with, its decorators counted."""
    decorators = statement.decorator_list if isinstance(statement, Function | ast.ClassDef) else []
    return min([statement.lineno, *(each.lineno for each in decorators)])


@lru_cache(maxsize=16)
def node_file(text: str, file: str = "") -> NodeFile:
    """The node of a file, by its text: the same one each time."""
    return NodeFile(text, file)


def started_node(trace: Trace) -> NodeFile:
    """The node of the file that was started."""
    return node_file(trace.sources.get(trace.file, ""), trace.file if len(trace.sources) > 1 else "")
