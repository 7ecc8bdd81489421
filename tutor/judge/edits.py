"""Next steps as edits of the learner's own file, tried on a copy first: a step that breaks the file is never given.

The source serves the words of a diagnosis, never a verdict.
"""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from pyflakes import checker, messages

from tutor.judge.source import Function, SourceFile

_NODE = {
    *(
        "add_on_set_parameters_callback",
        "add_post_set_parameters_callback",
        "create_client",
        "create_publisher",
        "create_rate",
        "create_service",
    ),
    *("create_subscription", "create_timer", "declare_parameter", "declare_parameters", "destroy_node"),
    *("destroy_timer", "executor", "get_clock", "get_logger", "get_name", "get_parameter", "get_parameter_or"),
    *("has_parameter", "set_parameters"),
}
"""What a node has of its own, as far as next steps use it."""


@dataclass(frozen=True, slots=True)
class Edit:
    """Lines `first` to `last` (counted from 1, both included) become `code`; where `last` is below `first`, none goes.

    `code` has no indentation of its own but what its later lines have more than the first; it gets that of line
    `like`, and four spaces more if it goes `deeper`.
    """

    first: int
    last: int
    code: str
    like: int = 0
    deeper: bool = False

    def __str__(self) -> str:
        """The edit in words, with its code: on the same line if it is one line, else below, four spaces indented."""
        lines = self.code.splitlines()
        code = f" {lines[0]}" if len(lines) == 1 else "".join("\n" + f"    {line}".rstrip() for line in lines)
        return f"{self._where}:{code}"

    @property
    def _where(self) -> str:
        if self.last > self.first:
            return f"lines {self.first} to {self.last} become"
        if self.last == self.first:
            return f"line {self.first} becomes"
        if not self.like:
            return "at the top of the file"
        if self.like == self.first:
            return f"write above line {self.first}, with the same indentation"
        if self.deeper:
            return f"write below line {self.last}, four spaces deeper"
        if self.like == self.last:
            return f"write below line {self.last}, with the same indentation"
        return f"write below line {self.last}, with the indentation of line {self.like}"


def replace_lines(line: int, code: str, last: int = 0) -> Edit:
    """Line `line`, or all lines up to `last`, with other code, indented as it is now."""
    return Edit(line, last or line, code, like=line)


def remove_lines(text: str, first: int, last: int = 0) -> Edit:
    """Lines taken out; where nothing else is left of their block, `pass` takes their place."""
    edit = Edit(first, last or first, "", like=first)
    return edit if _parses(apply(text, [edit])) else Edit(first, last or first, "pass", like=first)


def replace_statement(node: ast.stmt | ast.expr | ast.excepthandler, code: str) -> Edit:
    """All lines of a statement, with other code."""
    return replace_lines(node.lineno, code, node.end_lineno or 0)


def remove_statement(text: str, statement: ast.stmt | ast.expr) -> Edit:
    """A statement taken out."""
    return remove_lines(text, statement.lineno, statement.end_lineno or 0)


def insert_after(statement: ast.stmt, code: str) -> Edit:
    """Code written below a statement, indented as it is."""
    return insert_below(statement.end_lineno or statement.lineno, code, like=statement.lineno)


def insert_above(line: int, code: str) -> Edit:
    """Code written above a line, indented as it is."""
    return Edit(line, line - 1, code, like=line)


def insert_below(line: int, code: str, *, like: int = 0) -> Edit:
    """Code written below a line, indented as it is."""
    return Edit(line + 1, line, code, like=like or line)


def insert_into_block(line: int, code: str) -> Edit:
    """Code written below a line that ends in a colon, as the first of its block."""
    return Edit(line + 1, line, code, like=line, deeper=True)


def append_to_function(function: Function, code: str) -> Edit:
    """Code written where a function ends: before the `return` at its end, if there is one."""
    last = function.body[-1]
    if isinstance(last, ast.Return | ast.Raise):
        return insert_above(last.lineno, code)
    if isinstance(last, ast.Pass):
        return replace_lines(last.lineno, code)
    return insert_below(last.end_lineno or last.lineno, code, like=last.lineno)


def prepend_to_function(function: Function, code: str) -> Edit:
    """Code written as the first of a function, below its docstring."""
    first = function.body[0]
    if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and isinstance(first.value.value, str):
        return insert_below(first.end_lineno or first.lineno, code, like=first.lineno)
    return insert_above(first.lineno, code)


def return_on_every_path(function: Function, value: str) -> list[Edit]:
    """What makes every way through a function return this value, where it returned nothing."""
    inside = _own(function.body)
    found = [
        replace_lines(each.lineno, f"return {value}")
        for each in inside
        if isinstance(each, ast.Return) and (each.value is None or ast.unparse(each.value) == "None")
    ]
    if _falls_through(function.body):
        found.append(append_to_function(function, f"return {value}"))
    return found


def _own(body: Sequence[ast.stmt]) -> Iterator[ast.AST]:
    """What stands in these statements, without the functions inside."""
    for each in body:
        yield from _within(each)


def _within(node: ast.AST) -> Iterator[ast.AST]:
    yield node
    if not isinstance(node, Function | ast.ClassDef | ast.Lambda):
        for each in ast.iter_child_nodes(node):
            yield from _within(each)


def _falls_through(body: Sequence[ast.stmt]) -> bool:
    """Whether there is a way past the last of these statements."""
    match body[-1] if body else None:
        case ast.Return() | ast.Raise() | ast.Continue() | ast.Break():
            return False
        case ast.If(body=then, orelse=otherwise):
            return _falls_through(then) or _falls_through(otherwise)
        case ast.With(body=then) | ast.AsyncWith(body=then):
            return _falls_through(then)
        case ast.Try(body=then, handlers=handlers, orelse=otherwise, finalbody=at_last):
            if at_last and not _falls_through(at_last):
                return False
            return _falls_through(otherwise or then) or any(_falls_through(each.body) for each in handlers)
    return True


def replace_pattern(text: str, pattern: str, by: str) -> list[Edit]:
    """Each line that a pattern is found in, with it replaced."""
    found = []
    for number, line in enumerate(text.splitlines(), start=1):
        code = line.strip()
        if (new := re.sub(pattern, by, code)) != code:
            found.append(replace_lines(number, new))
    return found


def add_import(text: str, code: str) -> list[Edit]:
    """An import at the top of the file, below what must come first; nothing where the file has it."""
    tree = SourceFile(text).tree
    if code in {ast.unparse(each) for each in tree.body if isinstance(each, ast.Import | ast.ImportFrom)}:
        return []
    first = [each for each in tree.body if isinstance(each, ast.Import | ast.ImportFrom)]
    after = [each for each in first if isinstance(each, ast.ImportFrom) and each.module == "__future__"]
    if after:
        return [insert_below(after[-1].end_lineno or after[-1].lineno, code)]
    line = first[0].lineno if first else 1
    return [Edit(line, line - 1, code)]


def replace_imports(there: ast.ImportFrom, moved: Sequence[tuple[ast.alias, str]]) -> Edit:
    """Names taken out of an import, each with another import in its place, such as "from a.b import Name"."""
    rest = [each for each in there.names if each not in [alias for alias, _ in moved]]
    lines = [ast.unparse(ast.ImportFrom(there.module, rest, there.level))] if rest else []
    lines += [code + (f" as {alias.asname}" if alias.asname else "") for alias, code in moved]
    return replace_statement(there, "\n".join(lines))


def replace_node(text: str, node: ast.expr, new: str) -> Edit:
    """The lines in which an expression stands, with another one in its place."""
    return replace_nodes(text, (node, new))[0]


def replace_nodes(text: str, *swaps: tuple[ast.expr, str]) -> list[Edit]:
    """The lines in which expressions stand, each with another one in its place."""
    groups: list[list[tuple[ast.expr, str]]] = []
    end = 0
    for each in sorted(swaps, key=lambda swap: (swap[0].lineno, swap[0].col_offset)):
        if not groups or each[0].lineno > end:
            groups.append([])
        groups[-1].append(each)
        end = max(end, each[0].end_lineno or each[0].lineno)
    return [_swapped(text.splitlines(), group) for group in groups]


def _swapped(lines: Sequence[str], group: Sequence[tuple[ast.expr, str]]) -> Edit:
    first, last = group[0][0].lineno, max(node.end_lineno or node.lineno for node, _ in group)
    code = list(lines[first - 1 : last])
    for node, new in reversed(group):
        start, end = node.lineno - first, (node.end_lineno or node.lineno) - first
        head = code[start].encode()[: node.col_offset].decode()
        tail = code[end].encode()[node.end_col_offset or 0 :].decode()
        code[start : end + 1] = [f"{head}{new}{tail}"]
    margin = len(code[0]) - len(code[0].lstrip())
    return replace_lines(
        first, "\n".join(line[min(margin, len(line) - len(line.lstrip())) :].rstrip() for line in code), last
    )


def apply(text: str, edits: Sequence[Edit]) -> str:
    """The file with all edits done; their line numbers are those of the file as it is."""
    lines = text.splitlines()
    for edit in sorted(edits, key=lambda each: (each.first, each.last), reverse=True):
        lines[edit.first - 1 : max(edit.last, edit.first - 1)] = _indented(lines, edit)
    return "\n".join(lines) + "\n"


def _indented(lines: Sequence[str], edit: Edit) -> list[str]:
    if not edit.code:
        return []
    like = lines[edit.like - 1] if edit.like else ""
    margin = like[: len(like) - len(like.lstrip())] + ("    " if edit.deeper else "")
    return textwrap.indent(edit.code, margin).splitlines()


def describe_edits(text: str, *edits: Edit | Sequence[Edit], file: str = "") -> str | None:
    """The edits in words, as a next step: None where they would break the file, or would change nothing.

    A file is broken if Python cannot read it any more, or if the new code uses a name that nothing has given a value.
    """
    flat = [edit for each in edits for edit in ([each] if isinstance(each, Edit) else each)]
    edited = apply(text, flat)
    if not differs_in_words(text, edited) or not is_sound_change(text, edited):
        return None
    words = [_said(text, edit) for edit in flat]
    return (f"in {file}, " if file else "") + "\n".join(words)


def describe_edits_of(file: SourceFile, *edits: Edit | Sequence[Edit]) -> str | None:
    """The same of a file, called as it is there."""
    return describe_edits(file.text, *edits, file=file.file)


def is_already_there(text: str, edit: Edit) -> bool:
    """Whether an edit would write lines that stand above or below their place already."""
    if edit.last >= edit.first or not edit.code:
        return False
    code, lines = ([line.strip() for line in each.splitlines()] for each in (edit.code, text))
    place = edit.first - 1
    return code in (lines[place : place + len(code)], lines[max(0, place - len(code)) : place])


def differs_in_words(before: str, after: str) -> bool:
    """Whether more is another than the spaces within lines, and empty lines."""

    def words(text: str) -> list[tuple[int, list[str]]]:
        return [(len(line) - len(line.lstrip()), line.split()) for line in text.splitlines() if line.strip()]

    return words(before) != words(after)


def is_sound_change(before: str, after: str) -> bool:
    """Whether Python can read the file after a change, and knows each name of it that it knew before."""
    return _parses(after) and not _unknown(before, after)


def _said(text: str, edit: Edit) -> str:
    if edit.code:
        return str(edit)
    if edit.last > edit.first:
        return f"remove lines {edit.first} to {edit.last}"
    return f"remove line {edit.first}: {text.splitlines()[edit.first - 1].strip()}"


def _unknown(before: str, after: str) -> set[str]:
    """The names that the edited file uses and never sets, where the file as it was did not."""
    return set(_undefined(after)) - set(_undefined(before))


def _undefined(text: str) -> Iterator[str]:
    tree = ast.parse(text) if _parses(text) else ast.Module([], [])
    for found in checker.Checker(tree).messages:
        if isinstance(found, messages.UndefinedName | messages.UndefinedLocal):
            yield str(found.message_args[0])
    own = [each for each in ast.walk(tree) if isinstance(each, ast.Attribute) and ast.unparse(each.value) == "self"]
    kept = {each.attr for each in own if isinstance(each.ctx, ast.Store)} | _NODE
    for each in ast.walk(tree):
        if isinstance(each, Function | ast.ClassDef):
            kept.add(each.name)
        elif isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store):
            kept.add(each.id)  # of the class, not only of the object
    yield from (f"self.{each.attr}" for each in own if each.attr not in kept)


def _parses(text: str) -> bool:
    try:
        compile(text, "<edited>", "exec", dont_inherit=True)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return True
