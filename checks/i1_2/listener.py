"""I1.2: the callback of a learner's subscription, and the variables in which it keeps its state."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from checks.i1_2.facts import TOPIC
from tutor.judge import source
from tutor.judge.rewriting.node import argument
from tutor.judge.source import Function, SourceFile, is_abstract, last_name, values_of
from tutor.judge.trace import Trace

COUNT, FIRST, LAST, START, NUMBER = "total_count", "first_message", "last_message", "start_time", "last_number"
_CLOCKS = ("time", "monotonic", "perf_counter", "now", "time_ns", "monotonic_ns", "perf_counter_ns")
LEVELS = ("info", "warn", "warning", "error", "fatal")


@dataclass(frozen=True)
class Listener:
    """The callback of a subscription. `owner`: its class, if it is a method; `outer`: the enclosing function, if any.

    `reached`: the callback and the functions that it calls. `names`: the variable for each role COUNT, FIRST, ..., as
    written in the callback, if the file has one. These variables persist from one message to the next.
    """

    file: SourceFile
    created: ast.Call
    function: Function
    reached: tuple[Function, ...]
    owner: ast.ClassDef | None = None
    outer: Function | None = None
    names: Mapping[str, str] = field(default_factory=dict)

    @property
    def text(self) -> str:
        """The source text of the file."""
        return self.file.text

    @property
    def message(self) -> str:
        """The parameter for the message; "" if the callback takes none."""
        given = [each.arg for each in self.function.args.args if each.arg not in ("self", "cls")]
        return given[0] if given else ""

    @property
    def content(self) -> str:
        """The expression for the message's text: `msg.data`, or the parameter itself if a lambda passes the text."""
        given = [each for each in ast.walk(self.created) if isinstance(each, ast.Lambda)]
        taken = any(
            isinstance(node, ast.Attribute) and node.attr == "data" for each in given for node in ast.walk(each)
        )
        return self.message if taken or not self.message else f"{self.message}.data"

    @property
    def within(self) -> list[Function]:
        """The functions that run for a message and share the callback's variables."""
        return [each for each in self.reached if each is self.function or (self.owner and each in self.owner.body)]

    @property
    def logger(self) -> str:
        """The expression for the logger in the callback; "" if none is in scope."""
        node = ast.unparse(self.created.func.value) if isinstance(self.created.func, ast.Attribute) else "node"
        is_own = node == "self" and f"self.{self.function.name}" in map(ast.unparse, self.created.args)
        if self.owner is not None and (is_own or self.created in ast.walk(self.owner)):
            return f"{node}.get_logger()"
        for function in self.reached:
            is_foreign = self.file.class_of(function) is not self.owner  # its `self` is another object
            for call in (each for each in ast.walk(function) if isinstance(each, ast.Call)):
                if isinstance(call.func, ast.Attribute) and call.func.attr in LEVELS:
                    logger = ast.unparse(call.func.value)
                    if not (is_foreign and logger.startswith("self.")):
                        return logger
        return "" if self.owner else f"{node}.get_logger()"

    def name(self, role: str) -> str:
        """The variable for this role, as written in the callback: the file's own, or else a new one."""
        return self.names.get(role) or (f"self.{role}" if self.owner else role)

    def new_name(self, *names: str) -> str:
        """The first of these names that the file does not use yet, else the last one; as written in the callback."""
        free = [each for each in names if not re.search(rf"\b{each}\b", self.text)]
        return f"{'self.' if self.owner else ''}{(free or names[-1:])[0]}"


def find_listener(trace: Trace) -> Listener | None:
    """Find the callback of the node's subscription; None if there is none, or the file cannot be parsed."""
    files = source.files(trace)
    for created_in in files:
        for call in sorted(created_in.calls("create_subscription"), key=_is_for_another_topic):
            for passed in _passed_functions(call, created_in):
                file, function = _find_override(passed, created_in, files)
                parent = next(file.ancestors(function), None)
                owner = parent if isinstance(parent, ast.ClassDef) else None
                outer = file.function_around(function) if owner is None else None
                reached = tuple(file.reachable_from(function))
                return Listener(
                    file, call, function, reached, owner, outer, dict(_find_roles(function, reached, owner, file))
                )
    return None


def _find_override(function: Function, file: SourceFile, files: Sequence[SourceFile]) -> tuple[SourceFile, Function]:
    """The method of a derived class in another file that overrides this one, and its file; else the function itself."""
    owner = next(file.ancestors(function), None)
    if isinstance(owner, ast.ClassDef):
        for other in files:
            for each in other.functions if other is not file else ():
                derived = next(other.ancestors(each), None)
                bases = derived.bases if isinstance(derived, ast.ClassDef) else []
                if each.name == function.name and owner.name in map(last_name, bases):
                    return other, each
    return file, function


def _is_for_another_topic(call: ast.Call) -> bool:
    topic = argument(call, 1, "topic")
    return isinstance(topic, ast.Constant) and str(topic.value).strip("/") != TOPIC.strip("/")


def _passed_functions(call: ast.Call, file: SourceFile) -> Iterator[Function]:
    """The functions of the file that are passed to a call, or called by a lambda that is passed to it.

    A method of a derived class comes before that of the class which makes the subscription.
    """
    own = file.class_of(call)

    def rank(function: Function) -> tuple[bool, int]:
        owner = next(file.ancestors(function), None)
        derived = isinstance(owner, ast.ClassDef) and own is not None and own.name in map(last_name, owner.bases)
        return is_abstract(function), 0 if derived else 1 if own is None or owner is own else 2

    functions = sorted(file.functions, key=rank)
    for value in (*call.args, *(each.value for each in call.keywords)):
        parts = ast.walk(value) if isinstance(value, ast.Lambda | ast.Call) else [value]
        named = [name for each in parts if (name := last_name(each))]
        yield from (each for name in named for each in functions if each.name == name)


def _find_roles(
    function: Function, reached: Sequence[Function], owner: ast.ClassDef | None, file: SourceFile
) -> Iterator[tuple[str, str]]:
    """The persistent variables, as (role, variable). Of two with the same role, the first one counts.

    Variables of another class are out of scope; a variable that is also set elsewhere may have another purpose; an
    object that is None at first cannot hold one.
    """
    called = [node.value for node in function.body if isinstance(node, ast.Expr)]
    always = {source.called_name(each) for each in called if isinstance(each, ast.Call)} if owner else set()
    own = [each for each in reached if each is function or (each.name in always and owner and each in owner.body)]
    outside = [each for each in file.functions if each not in own and each.name != "__init__"]
    others = {name for each in outside for name, _, _ in _persistent_assignments(each)}
    found: dict[str, str] = {}
    for each in own:
        for target, value, with_each in _persistent_assignments(each):
            role = _role(value, each, with_each)
            late = any(isinstance(made, ast.Constant) for made in values_of(target.rpartition(".")[0], file.tree))
            if role and target not in others and not late and (role != START or not with_each):
                found.setdefault(role, target)
    yield from found.items()


def _persistent_assignments(function: Function) -> Iterator[tuple[str, ast.expr, bool]]:
    """The persistent variables that the function sets: (variable, value, whether each call sets it)."""
    declarations = [node for node in ast.walk(function) if isinstance(node, ast.Global | ast.Nonlocal)]
    persistent = {name for node in declarations for name in node.names}
    aliases = {
        target.id: ast.unparse(node.value)
        for node in function.body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Attribute)
        for target in node.targets
        if isinstance(target, ast.Name) and ast.unparse(node.value).startswith("self.")
    }
    for node in ast.walk(function):
        always = node in function.body
        if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add):
            pairs: list[tuple[ast.expr, ast.expr]] = [(node.target, ast.BinOp(node.target, node.op, node.value))]
        elif isinstance(node, ast.Assign):
            pairs = [pair for target in node.targets for pair in _pairs(target, node.value)]
        else:
            continue
        for target, value in pairs:
            root, _, rest = ast.unparse(target).partition(".")
            name = f"{aliases.get(root, root)}.{rest}" if rest else root
            if name.startswith("self.") or root in persistent:
                yield name, value, always


def _pairs(target: ast.expr, value: ast.expr) -> list[tuple[ast.expr, ast.expr]]:
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple) and len(target.elts) == len(value.elts):
        return list(zip(target.elts, value.elts, strict=True))
    return [(target, value)]


def _role(value: ast.expr, function: Function, always: bool) -> str:
    """The role of a variable that is set to this value, or ""."""
    given = {each.arg for each in function.args.args}
    match value:
        case ast.BinOp(left=ast.Name() | ast.Attribute(), op=ast.Add(), right=ast.Constant(value=1)):
            return COUNT if always else ""
        case ast.Attribute(attr="data", value=ast.Name(id=name)) if name in given:
            return LAST if always else FIRST
    local = value_of(value, function)
    called = {source.called_name(each) for each in ast.walk(local) if isinstance(each, ast.Call)}
    if isinstance(local, ast.Call) and called.intersection(_CLOCKS):
        return START
    return NUMBER if isinstance(local, ast.Call) and source.called_name(local) == "int" and always else ""


def value_of(value: ast.expr, function: Function) -> ast.expr:
    """The value of a local variable that is set only once; else the expression itself."""
    if not isinstance(value, ast.Name):
        return value
    given = values_of(value.id, function)
    return given[0] if len(given) == 1 else value
