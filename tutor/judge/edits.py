"""Next steps as edits of the learner's own file, tried on a copy first: a step that breaks the file is never shown.

The source only shapes the wording of a diagnosis, never a verdict.
"""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from tutor.judge.source import Function, SourceFile
from tutor.judge.source_changes import differs_in_words, is_sound_change, parses


@dataclass(frozen=True, slots=True)
class Edit:
    """Replace lines `first` to `last` (1-based, inclusive) by `code`; if `last` < `first`, insert above line `first`.

    `code` is dedented, so its first line starts at column 0. It gets the indentation of line `like`, plus four spaces
    if `deeper`.
    """

    first: int
    last: int
    code: str
    like: int = 0
    deeper: bool = False

    def __str__(self) -> str:
        """The edit in words, with its code: on the same line if it is one line, else below, indented by four spaces."""
        lines = self.code.splitlines()
        code = f" {lines[0]}" if len(lines) == 1 else "".join("\n" + f"    {line}".rstrip() for line in lines)
        return f"{self._place}:{code}"

    @property
    def _place(self) -> str:
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
    """Replace a line, or all lines from it to `last`, keeping the indentation."""
    return Edit(line, last or line, code, like=line)


def remove_lines(text: str, first: int, last: int = 0) -> Edit:
    """Remove lines, leaving `pass` in their place if the block would be empty without them."""
    edit = Edit(first, last or first, "", like=first)
    return edit if parses(apply(text, [edit])) else Edit(first, last or first, "pass", like=first)


def replace_statement(node: ast.stmt | ast.expr | ast.excepthandler, code: str) -> Edit:
    """Replace all lines of a statement."""
    return replace_lines(node.lineno, code, node.end_lineno or 0)


def remove_statement(text: str, statement: ast.stmt | ast.expr) -> Edit:
    """Remove a statement (see `remove_lines`)."""
    return remove_lines(text, statement.lineno, statement.end_lineno or 0)


def insert_after(statement: ast.stmt, code: str) -> Edit:
    """Insert code below a statement, with the statement's indentation."""
    return insert_below(statement.end_lineno or statement.lineno, code, like=statement.lineno)


def insert_above(line: int, code: str) -> Edit:
    """Insert code above a line, with the line's indentation."""
    return Edit(line, line - 1, code, like=line)


def insert_below(line: int, code: str, *, like: int = 0) -> Edit:
    """Insert code below a line, with the indentation of that line or of line `like`."""
    return Edit(line + 1, line, code, like=like or line)


def insert_into_block(line: int, code: str) -> Edit:
    """Insert code at the start of the block that a line ending in a colon opens."""
    return Edit(line + 1, line, code, like=line, deeper=True)


def append_to_function(function: Function, code: str) -> Edit:
    """Insert code at the end of a function: above its final `return` or `raise`, or in place of a final `pass`."""
    last = function.body[-1]
    if isinstance(last, ast.Return | ast.Raise):
        return insert_above(last.lineno, code)
    if isinstance(last, ast.Pass):
        return replace_lines(last.lineno, code)
    return insert_below(last.end_lineno or last.lineno, code, like=last.lineno)


def prepend_to_function(function: Function, code: str) -> Edit:
    """Insert code at the start of a function's body, below its docstring."""
    first = function.body[0]
    if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and isinstance(first.value.value, str):
        return insert_below(first.end_lineno or first.lineno, code, like=first.lineno)
    return insert_above(first.lineno, code)


def return_on_every_path(function: Function, value: str) -> list[Edit]:
    """Make every path through a function that returned nothing return this value."""
    found = [
        replace_lines(each.lineno, f"return {value}")
        for each in _walk_own(function.body)
        if isinstance(each, ast.Return) and (each.value is None or ast.unparse(each.value) == "None")
    ]
    if _falls_through(function.body):
        found.append(append_to_function(function, f"return {value}"))
    return found


def _walk_own(nodes: Iterable[ast.AST]) -> Iterator[ast.AST]:
    """Walk syntax trees depth-first, without descending into nested functions, lambdas and classes."""
    for node in nodes:
        yield node
        if not isinstance(node, Function | ast.ClassDef | ast.Lambda):
            yield from _walk_own(ast.iter_child_nodes(node))


def _falls_through(body: Sequence[ast.stmt]) -> bool:
    """Whether control can flow past the last of these statements."""
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
    """Replace a regular expression in every line where that changes anything."""
    found = []
    for number, line in enumerate(text.splitlines(), start=1):
        code = line.strip()
        if (new := re.sub(pattern, by, code)) != code:
            found.append(replace_lines(number, new))
    return found


def add_import(text: str, code: str) -> list[Edit]:
    """Add an import at the top of the file, below any `__future__` import; no edit if the file already has it."""
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
    """Take names out of an import, each replaced by an import of its own such as "from a.b import Name"."""
    rest = [each for each in there.names if each not in [alias for alias, _ in moved]]
    lines = [ast.unparse(ast.ImportFrom(there.module, rest, there.level))] if rest else []
    lines += [code + (f" as {alias.asname}" if alias.asname else "") for alias, code in moved]
    return replace_statement(there, "\n".join(lines))


def replace_node(text: str, node: ast.expr, new: str) -> Edit:
    """Replace an expression, as an edit of the lines that it spans."""
    return replace_nodes(text, (node, new))[0]


def remove_keyword(text: str, call: ast.Call, name: str) -> Edit:
    """Remove a keyword argument from a call."""
    kept = [each for each in call.keywords if each.arg != name]
    return replace_node(text, call, ast.unparse(ast.Call(call.func, call.args, kept)))


def replace_parameters(text: str, function: Function, names: Sequence[str]) -> list[Edit]:
    """Give a function these parameters; no edit if its first line does not hold all of them, or they are the same."""
    line = text.splitlines()[function.lineno - 1].strip()
    head = re.sub(r"\([^()]*\)", f"({', '.join(names)})", line, count=1)
    return [replace_lines(function.lineno, head)] if head != line else []


def replace_nodes(text: str, *swaps: tuple[ast.expr, str]) -> list[Edit]:
    """Replace expressions, as edits of the lines that they span; expressions that share lines share an edit."""
    groups: list[list[tuple[ast.expr, str]]] = []
    end = 0
    for each in sorted(swaps, key=lambda swap: (swap[0].lineno, swap[0].col_offset)):
        if not groups or each[0].lineno > end:
            groups.append([])
        groups[-1].append(each)
        end = max(end, each[0].end_lineno or each[0].lineno)
    return [_swap(text.splitlines(), group) for group in groups]


def _swap(lines: Sequence[str], group: Sequence[tuple[ast.expr, str]]) -> Edit:
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
    """The text with all edits applied; their line numbers refer to the original text."""
    lines = text.splitlines()
    for edit in sorted(edits, key=lambda each: (each.first, each.last), reverse=True):
        lines[edit.first - 1 : max(edit.last, edit.first - 1)] = _indent(lines, edit)
    return "\n".join(lines) + "\n"


def _indent(lines: Sequence[str], edit: Edit) -> list[str]:
    if not edit.code:
        return []
    like = lines[edit.like - 1] if edit.like else ""
    margin = like[: len(like) - len(like.lstrip())] + ("    " if edit.deeper else "")
    return textwrap.indent(edit.code, margin).splitlines()


def describe_edits(text: str, *edits: Edit | Sequence[Edit], file: str = "", defined: Iterable[str] = ()) -> str | None:
    """The edits in words, as a next step; None if they would break the file or change nothing.

    The file is broken if Python can no longer parse it, or if the new code uses an undefined name. `defined`: names
    that are defined elsewhere, such as "self.timer" in a base class.
    """
    flat = [edit for each in edits for edit in ([each] if isinstance(each, Edit) else each)]
    edited = apply(text, flat)
    if not differs_in_words(text, edited) or not is_sound_change(text, edited, defined):
        return None
    return (f"in {file}, " if file else "") + "\n".join(_describe_edit(text, edit) for edit in flat)


def describe_edits_of(file: SourceFile, *edits: Edit | Sequence[Edit], defined: Iterable[str] = ()) -> str | None:
    """`describe_edits` for a source file, under its own name."""
    return describe_edits(file.text, *edits, file=file.file, defined=defined)


def is_already_there(text: str, edit: Edit) -> bool:
    """Whether an edit would insert lines that already stand right above or below the insertion point."""
    if edit.last >= edit.first or not edit.code:
        return False
    code, lines = ([line.strip() for line in each.splitlines()] for each in (edit.code, text))
    place = edit.first - 1
    return code in (lines[place : place + len(code)], lines[max(0, place - len(code)) : place])


def _describe_edit(text: str, edit: Edit) -> str:
    if edit.code:
        return str(edit)
    if edit.last > edit.first:
        return f"remove lines {edit.first} to {edit.last}"
    return f"remove line {edit.first}: {text.splitlines()[edit.first - 1].strip()}"
