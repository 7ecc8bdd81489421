"""Mistakes of Python that raise no exception, and that ROS makes easy."""

from __future__ import annotations

import ast
import contextlib
import io
import re
import tokenize
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import last_name, values_of

_VALUES = (
    Symptom.WRONG_VALUES,
    Symptom.WRONG_RATE,
    Symptom.WRONG_LOG,
    Symptom.NOT_LOGGED,
    Symptom.WRONG_ANSWER,
    Symptom.CHANGE_IGNORED,
)

_Closure = ast.Lambda | ast.FunctionDef | ast.AsyncFunctionDef


@mistake(
    "caret-is-no-power",
    name="^ is not a power",
    explains=_VALUES,
    slip=True,
    says="{line}: {wrong} is {value}, since ^ is a bitwise XOR: {code}",
    do="Write {right}.",
)
def caret(case: Case) -> Iterator[Found]:
    """^ is used as a power.

    In Python, ^ combines bits, so 10^9 is 3; a power is written with **.

    Bad:

        nanoseconds = seconds * 10^9

    Good:

        nanoseconds = seconds * 10**9

    See it: `python3 -c "print(10^9)"`.
    """
    for file in case.files:
        for node in file.nodes:
            if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.BitXor):
                continue
            base = node.left.right if isinstance(node.left, ast.BinOp) else node.left  # x / 10^9 is (x / 10) ^ 9
            power = node.right.left if isinstance(node.right, ast.BinOp) else node.right
            match base, power:
                case ast.Constant(value=int() as one), ast.Constant(value=int() as other) if one in (2, 10):
                    yield found(file, node, wrong=f"{one}^{other}", value=one ^ other, right=f"{one}**{other}")


@mistake(
    "never-none",
    name="never None",
    explains=_VALUES,
    says="{line} tests whether {name} is None, but it starts as {value}: {code}",
    do="Let {name} start as None.",
)
def never_none(case: Case) -> Iterator[Found]:
    """An attribute is compared with None, but never is None.

    0 and an empty text are values. "is None" asks whether there is no value at all, which is true only if the attribute
    started as None.

    Bad:

        def __init__(self):
            self.first = 0

        def on_ring(self, message):
            if self.first is None:
                self.first = message.data

    Good:

        def __init__(self):
            self.first = None

        def on_ring(self, message):
            if self.first is None:
                self.first = message.data

    See it: log the attribute once at the start.
    """
    for file in case.files:
        for test in file.nodes:
            match test:
                case ast.If(
                    test=ast.Compare(left=ast.Attribute() as left, ops=[ast.Is()], comparators=[ast.Constant(None)])
                ):
                    name = ast.unparse(left)
                case _:
                    continue
            within = [node for statement in test.body for node in ast.walk(statement)]
            initial = [value for value in values_of(name, file.tree) if value not in within]
            is_set = any(isinstance(node, ast.Assign) and name in map(ast.unparse, node.targets) for node in within)
            if is_set and len(initial) == 1 and isinstance(initial[0], ast.Constant) and initial[0].value is not None:
                yield found(file, test, name=name, value=ast.unparse(initial[0]))


@mistake(
    "no-f-in-front-of-the-text",
    explains=(Symptom.NOT_LOGGED, Symptom.WRONG_LOG, Symptom.WRONG_VALUES, Symptom.CHANGE_IGNORED),
    slip=True,
    says="{line} has {placeholder} in a text without f in front, so the name is shown and not its value: {code}",
    do="Put an f in front of the quotation mark.",
    example=in_run(Symptom.NOT_LOGGED, logs=["owner: {self.owner}"]),
)
def missing_f(case: Case) -> Iterator[Found]:
    """A text has placeholders, but no f in front.

    Python fills in {…} only in texts that begin with f. Without it, the braces and the name are shown as they are.

    Bad:

        self.get_logger().info('owner: {self.owner}')

    Good:

        self.get_logger().info(f'owner: {self.owner}')

    See it: the log shows the braces.
    """
    if case.about("no_message"):  # it is not the value in a message that is missing
        return
    shown = [log.text for log in case.trace.logs]
    shown += [str(sample.message) for samples in case.trace.samples.values() for sample in samples[-3:]]
    seen = "\n".join(shown)
    for file in case.files:
        with contextlib.suppress(tokenize.TokenError, SyntaxError):
            for token in tokenize.generate_tokens(io.StringIO(file.text).readline):
                if token.type == tokenize.STRING and token.string[0].lower() not in "bu":
                    for placeholder in re.findall(r"\{[A-Za-z_][^{}\n]*\}", token.string):
                        if placeholder in seen:
                            yield Found(
                                {"placeholder": placeholder}, file.name, token.start[0], file.line(token.start[0])
                            )


@mistake(
    "one-object-two-names",
    name="one object, two names",
    explains=_VALUES,
    says="{line}: {names} are one object, so changing one changes the other: {code}",
    do="Make a separate object for each of them.",
)
def shared_object(case: Case) -> Iterator[Found]:
    """Two names are given one object.

    a = b = {} makes one dict with two names: what is put into one is in the other as well. Numbers and texts are safe,
    since they cannot be changed.

    Bad:

        self.rung = self.opened = []

    Good:

        self.rung = []
        self.opened = []

    See it: log both after changing one.
    """
    for file in case.files:
        for node in file.nodes:
            match node:
                case ast.Assign(targets=[_, _, *_], value=value) if _can_be_changed(value):
                    yield found(file, node, names=" and ".join(map(ast.unparse, node.targets)))


def _can_be_changed(value: ast.expr) -> bool:
    """Whether a value is a container, or an object of a class: what functions return is mostly a number or a text."""
    match value:
        case ast.Dict() | ast.List() | ast.Set():
            return True
        case ast.Call(func=function):
            name = last_name(function)
            return name[:1].isupper() or name in ("dict", "list", "set", "deque", "defaultdict")
    return False


@mistake(
    "late-binding",
    explains=(Symptom.WRONG_ANSWER, Symptom.WRONG_VALUES, Symptom.CALLS_MISSING, Symptom.WRONG_LOG),
    says="{line} makes a function in a loop that looks {names} up when it is called, after the last iteration: {code}",
    do="Bind {names} when the function is made, as a default value of a parameter or with functools.partial.",
)
def late_binding(case: Case) -> Iterator[Found]:
    """A function made in a loop sees the loop's last value.

    A lambda or an inner function looks up its variables when it is called. By then the loop has ended, and its variable
    has the last value, for all the functions that were made.

    Bad:

        for room in self.rooms:
            self.create_service(Trigger, room, lambda request, response: self.ring(room, response))

    Good:

        for room in self.rooms:
            self.create_service(Trigger, room, lambda request, response, room=room: self.ring(room, response))

    See it: call each of them: they all do the same.
    """
    for file in case.files:
        for loop in file.nodes:
            if isinstance(loop, ast.For):
                variables, inside = {*_assigned(loop)}, [node for part in loop.body for node in ast.walk(part)]
            elif isinstance(loop, ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp):
                variables = {name for generator in loop.generators for name in _assigned(generator.target)}
                inside = list(ast.walk(loop))
            else:
                continue
            for function in (node for node in inside if isinstance(node, _Closure)):
                if names := _late_names(function, variables):
                    yield found(file, function, names=" and ".join(names))


def _late_names(function: _Closure, variables: set[str]) -> list[str]:
    body = function.body if isinstance(function.body, list) else [function.body]
    read = [node for part in body for node in ast.walk(part) if isinstance(node, ast.Name)]
    parameters = {node.arg for node in ast.walk(function.args) if isinstance(node, ast.arg)}
    local = parameters | {node.id for node in read if not isinstance(node.ctx, ast.Load)}
    return list(dict.fromkeys(node.id for node in read if node.id in variables - local))


def _assigned(node: ast.AST) -> list[str]:
    """The variables assigned in this node, functions inside it left out."""
    own = [node.id] if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) else []
    children = () if isinstance(node, _Closure) else ast.iter_child_nodes(node)
    return own + [name for child in children for name in _assigned(child)]
