"""Edits of known exceptions that need its syntax tree, or a try: `{ rewritten = NAME }` in the tables."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence

from tutor.judge import edits
from tutor.judge.edits import Edit
from tutor.judge.rewriting.syntax import slips
from tutor.judge.source import Function, SourceFile, called_name, last_name, syntax_nodes

Words = Mapping[str, str]

_LEVELS = ("debug", "info", "warn", "warning", "error", "fatal")
_PLACEHOLDER = re.compile(r"%[-+ #0-9.]*[sdifrgxe]")


def log(text: str, words: Words) -> Sequence[Edit]:
    """Log calls with values behind the text, as those of logging are written: one text each."""
    there = SourceFile(text).statement_at(int(words["number"]))
    if there is None:
        return []
    calls = [each for each in syntax_nodes(text) if isinstance(each, ast.Call) and called_name(each) in _LEVELS]
    calls = [each for each in calls if len(each.args) > 1 and isinstance(each.func, ast.Attribute)]
    loggers = {_receiver(each) for each in calls if there.lineno <= each.lineno <= (there.end_lineno or 0)}
    found = [each for each in calls if _receiver(each) in loggers or _receiver(each).endswith("get_logger()")]
    return edits.replace_nodes(text, *((each, _one_text(text, each)) for each in found))


def _receiver(call: ast.Call) -> str:
    return ast.unparse(call.func.value) if isinstance(call.func, ast.Attribute) else ""


def _one_text(text: str, call: ast.Call) -> str:
    first, *rest = (ast.get_source_segment(text, each) or ast.unparse(each) for each in call.args)
    said = call.args[0].value if isinstance(call.args[0], ast.Constant) else ""
    starred = any(isinstance(each, ast.Starred) for each in call.args)
    plain = len(rest) == 1 and isinstance(call.args[1], ast.Name | ast.Attribute | ast.Constant)
    if isinstance(said, str) and not starred and len(_PLACEHOLDER.findall(said)) == len(rest):
        one = f"{first} % " + (rest[0] if plain else f"({', '.join(rest)}{',' * (len(rest) == 1)})")
    elif isinstance(said, str) and not starred and said.count("{") == len(rest):
        one = f"{first}.format({', '.join(rest)})"
    else:
        one = f"' '.join(map(str, ({', '.join([first, *rest])})))"
    more = "".join(f", {ast.unparse(each)}" for each in call.keywords)
    return f"{ast.unparse(call.func)}({one}{more})"


def imported(text: str, words: Words) -> Sequence[Edit] | None:
    """A name taken out of an import, and imported from where it is; under its right name wherever it is used."""
    there = SourceFile(text).statement_at(int(words["number"]))
    if not isinstance(there, ast.ImportFrom):
        return None
    name, right = words["name"], words.get("nearest") or words["name"]
    taken = next((each for each in there.names if each.name == name), None)
    if taken is None:
        return None
    uses = [each for each in syntax_nodes(text) if isinstance(each, ast.Name) and each.id == name and right != name]
    swaps = [] if taken.asname else edits.replace_nodes(text, *((each, right) for each in uses))
    return [edits.replace_imports(there, [(taken, words["found"])]), *swaps]


def types_first(text: str, words: Words) -> Sequence[Edit]:
    """Each call that makes something of a node's, with the type in front of the name."""
    swaps: list[tuple[ast.expr, str]] = []
    for call in syntax_nodes(text):
        if not isinstance(call, ast.Call) or not re.fullmatch(r"create_(?!timer|rate)\w+", called_name(call)):
            continue
        name, kind = (*call.args, None, None)[:2]
        last = ast.unparse(kind).rpartition(".")[2] if isinstance(kind, ast.Name | ast.Attribute) else ""
        first = ast.unparse(name).rpartition(".")[2] if name is not None else ""
        if name is None or kind is None or not _type(last) or _type(first):
            continue
        swaps += [(name, ast.unparse(kind)), (kind, ast.unparse(name))]
    return edits.replace_nodes(text, *swaps)


def _type(name: str) -> bool:
    return name[:1].isupper() and not name.isupper()


def without(text: str, words: Words) -> Sequence[Edit] | None:
    """A statement taken out, with those that only use what it makes."""
    there = SourceFile(text).statement_at(int(words["number"]))
    if there is None:
        return None
    made = ast.unparse(there.targets[0]) if isinstance(there, ast.Assign) else ""
    uses = [each for each in syntax_nodes(text) if made and isinstance(each, ast.Expr) and _uses(each, made)]
    return [edits.remove_statement(text, each) for each in (there, *uses)]


def _uses(statement: ast.stmt, made: str) -> bool:
    return any(isinstance(each, ast.Attribute | ast.Name) and ast.unparse(each) == made for each in ast.walk(statement))


def raised(text: str, words: Words) -> Sequence[Edit] | None:
    """What a callback raises is logged; a parameter callback refuses the change, with what was raised as the reason."""
    there = SourceFile(text).statement_at(int(words["number"]))
    function = SourceFile(text).function_at(there.lineno) if there is not None else None
    if not isinstance(there, ast.Raise) or there.exc is None or function is None:
        return None
    given = there.exc.args[0] if isinstance(there.exc, ast.Call) and there.exc.args else there.exc
    what = ast.unparse(given) if isinstance(given, ast.Constant | ast.JoinedStr) else f"str({ast.unparse(given)})"
    end = there.end_lineno or there.lineno
    for checks in _callbacks(text, "add_on_set_parameters_callback"):
        if checks.name == function.name:
            code = f"return SetParametersResult(successful=False, reason={what})"
            return [*_result(text), edits.replace_lines(there.lineno, code, end)]
        calls = [each for each in ast.walk(checks) if isinstance(each, ast.Call) and called_name(each) == function.name]
        if calls:
            return [*_result(text), _refused(text, SourceFile(text).statement_at(calls[0].lineno))]
    me = function.args.args[0].arg if function.args.args else ""
    if me != "self" or function.name == "__init__":
        return None
    answers = [each for each in _callbacks(text, "create_service") if each.name == function.name]
    back = f"return {answers[0].args.args[-1].arg}" if answers else "return"
    return [edits.replace_lines(there.lineno, f"self.get_logger().error({what})\n{back}", end)]


def _result(text: str) -> Sequence[Edit]:
    has = re.search(r"import .*\bSetParametersResult\b|^\s*SetParametersResult,?\s*$", text, re.MULTILINE)
    return [] if has else edits.add_import(text, "from rcl_interfaces.msg import SetParametersResult")


def _refused(text: str, there: ast.stmt | None) -> Edit:
    assert there is not None
    end = there.end_lineno or there.lineno
    code = textwrap.indent(textwrap.dedent("\n".join(text.splitlines()[there.lineno - 1 : end])), "    ")
    refuse = "return SetParametersResult(successful=False, reason=str(error))"
    return edits.replace_lines(there.lineno, f"try:\n{code}\nexcept Exception as error:\n    {refuse}", end)


def _callbacks(text: str, create: str) -> Iterator[Function]:
    for call in syntax_nodes(text):
        if isinstance(call, ast.Call) and called_name(call) == create:
            for each in (*call.args, *(given.value for given in call.keywords)):
                yield from SourceFile(text).named(last_name(each))[-1:]


def optional(text: str, words: Words) -> Sequence[Edit]:
    """A command line none of whose arguments is required, and which lets those of ROS be."""
    swaps: list[tuple[ast.expr, str]] = []
    for call in syntax_nodes(text):
        if isinstance(call, ast.Call) and called_name(call) == "parse_args":
            swaps.append((call, f"{ast.unparse(call).replace('.parse_args(', '.parse_known_args(')}[0]"))
        if isinstance(call, ast.Call) and called_name(call) == "add_argument" and call.args:
            names = [ast.unparse(each) for each in call.args]
            kept = [each for each in call.keywords if each.arg != "required"]
            if not (positional := names[0][1:2] != "-") and len(kept) == len(call.keywords):
                continue
            if positional:
                names = [f"{names[0][0]}--{names[0][1:]}"]
            given = [f"{each.arg}={ast.unparse(each.value)}" for each in kept]
            given += [] if any(each.arg == "default" for each in kept) else ["default='1'"]
            swaps.append((call, f"{ast.unparse(call.func)}({', '.join([*names, *given])})"))
    return edits.replace_nodes(text, *swaps)


def utf8(text: str, words: Words) -> Sequence[Edit]:
    """The encoding, in each call of a statement that opens a file without one."""
    there = SourceFile(text).statement_at(int(words["number"]))
    swaps: list[tuple[ast.expr, str]] = []
    for call in ast.walk(there) if there is not None else ():
        if not isinstance(call, ast.Call) or called_name(call) not in ("open", "read_text", "write_text"):
            continue
        if not any(each.arg == "encoding" for each in call.keywords):
            whole = ast.get_source_segment(text, call) or ast.unparse(call)
            more = ", " if call.args or call.keywords else ""
            swaps.append((call, f"{whole[:-1].rstrip().rstrip(',')}{more}encoding='utf-8')"))
    return edits.replace_nodes(text, *swaps[:1])


def readable(text: str, words: Words) -> Sequence[Edit] | None:
    """The smallest change after which Python can read the file."""
    return slips(text)


REWRITERS: Mapping[str, Callable[[str, Words], Sequence[Edit] | None]] = {
    each.__name__: each for each in (log, imported, types_first, readable, without, raised, optional, utf8)
}
"""The edits by their names in the tables; each takes the file's text and the words of the exception."""
