"""A learner's node as next steps see it: its functions, and the names that the file gives its parts.

Read from the syntax tree. It only shapes the wording of a diagnosis, never a verdict.
"""

from __future__ import annotations

import ast
import textwrap
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
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
from tutor.judge.tracebacks import Frame

_SETUP_CALLS = ("create_publisher", "create_timer", "declare_parameter", "declare_parameters")


@dataclass(frozen=True)
class NodeFile(SourceFile):
    """A file that contains one node. Its results are parts of `tree`, or code."""

    @cached_property
    def name(self) -> str:
        """The node's name where its publisher, timer and parameters are created: usually "self"."""
        owners = [
            ast.unparse(each.func.value) for each in self.calls(*_SETUP_CALLS) if isinstance(each.func, ast.Attribute)
        ]
        if owners:
            return Counter(owners).most_common(1)[0][0]
        return next(
            (target for call in self.calls("create_node", "Node") if (target := self.assigned_to(call))), "self"
        )

    @property
    def owner(self) -> str:
        """The object of which a timer becomes an attribute, if it is not one yet: usually "self"."""
        return self.name.partition(".")[0]

    @cached_property
    def setup(self) -> Function | None:
        """The function that sets the node up: usually `__init__`; None if there is none."""
        creation = next(
            (each for each in self.calls("create_node", "Node") if self.assigned_to(each) == self.name), None
        )
        if creation is not None:
            return self.function_around(creation)
        made = [each for each in self.calls(*_SETUP_CALLS) if self.function_around(each) is not None]
        inits = [each for each in self.functions if each.name == "__init__" and self.class_of(each) is not None]
        if inits and (self.name.startswith("self") or not made):
            return next((each for each in inits if any(self.function_around(call) is each for call in made)), inits[0])
        return self.function_around(made[0]) if made else None

    @cached_property
    def timers(self) -> list[ast.Call]:
        """The calls that create timers."""
        return self.calls("create_timer")

    @cached_property
    def first_timer(self) -> ast.Call | None:
        """The call that creates the initial timer: the first one reached from the setup, else the first in the file.

        With several timers, the first one whose callback publishes.
        """
        initial = [
            each for each in self.timers if self.setup and self.function_around(each) in self.reachable_from(self.setup)
        ]
        found = initial or self.timers
        publishing = [each for each in found if self._publishes(argument(each, 1, "callback"))] if found[1:] else []
        return next(iter(publishing or found), None)

    def _publishes(self, callback: ast.expr | None) -> bool:
        function = self.function(callback)
        reached = self.reachable_from(function) if function is not None else []
        return any(self.function_around(each) in reached for each in self.calls("publish"))

    @cached_property
    def timer_callback(self) -> Function | None:
        """The timer's callback; if there is none, the function that publishes."""
        made = [self.first_timer] if self.first_timer else []
        callbacks = [found for each in made if (found := self.function(argument(each, 1, "callback"))) is not None]
        publishing = [found for each in self.calls("publish") if (found := self.function_around(each)) is not None]
        return next(iter([*callbacks, *publishing]), None)

    @cached_property
    def publisher(self) -> str:
        """The name of the publisher, such as "self.publisher"; empty if there is none."""
        made = (self.assigned_to(each) for each in self.calls("create_publisher", "create_lifecycle_publisher"))
        return next((each for each in made if each), "")

    @property
    def message_class(self) -> str:
        """The name of the message class that is published, as the file imports it; empty if unknown."""
        made = next(iter(self.calls("create_publisher", "create_lifecycle_publisher")), None)
        given = argument(made, 0, "msg_type") if made is not None else None
        return ast.unparse(given) if given is not None else ""

    def value(self, parameter: str) -> str:
        """The code that reads a parameter's value."""
        return f"{self.name}.get_parameter({parameter!r}).value"

    def append_to_setup(self, code: str) -> list[Edit]:
        """Insert code into the setup, below the last line that creates publishers, timers and parameters."""
        made = [self.statement(each) for each in self.calls(*_SETUP_CALLS) if self.function_around(each) is self.setup]
        if made:
            last = max(made, key=lambda each: each.end_lineno or each.lineno)
            return [insert_after(last, code)]
        return [append_to_function(self.setup, code)] if self.setup is not None else []

    def prepend_to(self, function: Function, code: str) -> list[Edit]:
        """Insert code at the start of a function, below its docstring."""
        first = function.body[0]
        is_docstring = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
        if is_docstring and len(function.body) > 1:
            first = function.body[1]
        elif is_docstring:
            return [insert_after(first, code)]
        if first.lineno == function.lineno:
            return []
        return [insert_above(first_line(first), code)]

    def import_name(self, name: str, module: str) -> tuple[str, list[Edit]]:
        """The name under which the file has something from a module, and the edits that import it from there alone."""
        known = self.imported_name(name, module)
        if known is None:
            return name, self._import_from(name, module)
        return known, self._import_from(name, module) if self._imports_from_elsewhere(known, module) else []

    def imported_name(self, name: str, module: str) -> str | None:
        """The name under which the file imports something from a module; None if it does not."""
        for each, alias in self.imports:
            if isinstance(each, ast.ImportFrom) and (each.module, alias.name) == (module, name):
                return alias.asname or name
            if isinstance(each, ast.ImportFrom) and f"{each.module}.{alias.name}" == module:
                return f"{alias.asname or alias.name}.{name}"
            if isinstance(each, ast.Import) and alias.name == module:
                return f"{alias.asname or module}.{name}"
        return None

    def _imports_from_elsewhere(self, name: str, module: str) -> list[tuple[ast.ImportFrom, ast.alias]]:
        """The imports that give this name to something of another module."""
        return [
            (each, alias)
            for each, alias in self.imports
            if isinstance(each, ast.ImportFrom) and each.module != module and (alias.asname or alias.name) == name
        ]

    def _import_from(self, name: str, module: str) -> list[Edit]:
        """Import a name from a module, in place of one of the same name from another module."""
        code = f"from {module} import {name}"
        for each, alias in self._imports_from_elsewhere(name, module):
            others = [other for other in each.names if other is not alias]
            if not others:
                return [replace_statement(each, code)]
            rest = ast.unparse(ast.ImportFrom(each.module, others, each.level))
            return [replace_statement(each, f"{rest}\n{code}")]
        return add_import(self.text, code)

    def new_method(self, code: str) -> list[Edit]:
        """Add a method at the end of the node's class; no edit for a node without a class."""
        owner = self.class_of(self.setup) if self.setup is not None else None
        if owner is None:
            return []
        last = owner.body[-1]
        return [insert_below(last.end_lineno or last.lineno, "\n" + code, like=first_line(last))]

    def step(self, *choices: Sequence[Edit] | None) -> str | None:
        """The first of these choices that leaves a sound file (see `describe_edits`), in words; None if none does.

        The lowest edit comes first, so that the line numbers of the others stay correct when they are done in turn.
        """
        missing = ([edit for edit in each or () if not is_already_there(self.text, edit)] for each in choices)
        described = (
            describe_edits(self.text, *_bottom_up(each), file=self.file)
            for each in missing
            if each and self.text.strip()
        )
        return next((words for words in described if words is not None), None)


def _bottom_up(edits: Sequence[Edit]) -> list[Edit]:
    """The edits, lowest first, without those whose lines another edit replaces entirely."""

    def covers(other: Edit, edit: Edit) -> bool:
        if edit.last < edit.first:
            return other.first < edit.first <= other.last
        return other.first <= edit.first and edit.last <= other.last and other != edit

    def covered(edit: Edit) -> bool:
        return any(covers(other, edit) and not covers(edit, other) for other in edits)

    remaining = [edit for edit in edits if not covered(edit)]
    return sorted(dict.fromkeys(remaining), key=lambda edit: edit.first, reverse=True)


def argument(call: ast.Call, position: int, name: str) -> ast.expr | None:
    """An argument of a call, passed by position or by name; None if it is missing."""
    if len(call.args) > position and not any(isinstance(each, ast.Starred) for each in call.args):
        return call.args[position]
    return next((each.value for each in call.keywords if each.arg == name), None)


def with_body(function: Function, code: str) -> Edit:
    """Replace a function's body below its docstring; the header is rewritten only if the edit cannot leave it alone."""
    first = function.body[1 if ast.get_docstring(function) is not None and len(function.body) > 1 else 0]
    end = function.end_lineno or function.lineno
    below_header = first.lineno > max(each.lineno for each in (function, *function.args.args))
    if below_header and isinstance(function, ast.FunctionDef) and not function.decorator_list:
        return replace_lines(first.lineno, code, end)
    static = "@staticmethod\n" if is_static(function) else ""
    returns = f" -> {ast.unparse(function.returns)}" if function.returns is not None else ""
    head = f"{static}def {function.name}({ast.unparse(function.args)}){returns}:"
    return replace_lines(first_line(function), f"{head}\n{textwrap.indent(code, '    ')}", end)


def is_static(function: Function) -> bool:
    """Whether a method is a static method."""
    return any(ast.unparse(each) == "staticmethod" for each in function.decorator_list)


def rewrite_function(function: Function, code: str, *, parameter: str = "") -> Edit:
    """Replace everything below a function's header.

    `parameter`: for a parameter callback, the parameter that it must take. rclpy awaits no such callback.
    """
    taken, names = ast.unparse(function.args), [each.arg for each in function.args.args]
    if parameter and parameter not in names:
        taken = ", ".join([*names[:1], parameter] if names[:1] in (["self"], ["cls"]) else [parameter])
    is_coroutine = isinstance(function, ast.AsyncFunctionDef) and not parameter
    head = f"{'async ' if is_coroutine else ''}def {function.name}({taken})"
    returns = f" -> {ast.unparse(function.returns)}" if function.returns is not None else ""
    lines = [f"{head}{returns}:", *(f"    {line}" for line in code.splitlines())]
    return replace_statement(function, "\n".join(lines))


def first_line(statement: ast.stmt) -> int:
    """The first line of a statement, including its decorators."""
    decorators = statement.decorator_list if isinstance(statement, Function | ast.ClassDef) else []
    return min([statement.lineno, *(each.lineno for each in decorators)])


@lru_cache(maxsize=16)
def node_file(text: str, file: str = "") -> NodeFile:
    """The node of a file, by its text; equal texts share one object."""
    return NodeFile(text, file)


def started_node(trace: Trace) -> NodeFile:
    """The node of the file that was run."""
    return node_file(trace.sources.get(trace.file, ""), trace.file if len(trace.sources) > 1 else "")


def file_calling(trace: Trace, *names: str) -> NodeFile:
    """The node of the first file that calls one of these functions; else that of the file that was run."""
    return find_in_files(trace, lambda file: file if file.calls(*names) else None) or started_node(trace)


def file_of(trace: Trace, at: Frame) -> NodeFile:
    """The node of the file that a stack frame is in."""
    return node_file(trace.sources.get(at.name, ""), at.name if len(trace.sources) > 1 else "")


def node_files(trace: Trace) -> Iterator[NodeFile]:
    """The file that was run, then its local imports."""
    yield started_node(trace)
    yield from (node_file(text, name) for name, text in trace.sources.items() if name != trace.file)


def find_in_files[T](trace: Trace, *finders: Callable[[NodeFile], T | None]) -> T | None:
    """What one of these functions finds, in the file that was run or else in its local imports."""
    for file in node_files(trace):
        for find in finders:
            if (found := find(file)) is not None:
                return found
    return None
