"""The program around a learner's node, rewritten: what makes the node, runs its callbacks, and ends with Ctrl+C."""

from __future__ import annotations

import ast
import textwrap
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import takewhile

from tutor.judge.edits import Edit, add_import, insert_after, insert_below, replace_statement
from tutor.judge.rewriting.node import NodeFile, first_line, node_file
from tutor.judge.source import Function, called_name, calls_in
from tutor.judge.trace import Trace

SPINS = ("spin", "spin_once", "spin_some", "spin_until_future_complete")
_EXECUTORS = ("SingleThreadedExecutor", "MultiThreadedExecutor", "EventsExecutor")
_REPLACED = {
    *(*SPINS, *_EXECUTORS, "add_node", "remove_node", "destroy_node", "shutdown", "try_shutdown", "install"),
    *("sleep", "join", "wait", "signal", "register", "exit", "_exit", "abort", "kill", "terminate", "on_shutdown"),
}
"""What a program does to run its node, and to end: none of it is kept."""

_THREADS = 8


@dataclass(frozen=True)
class _Scope:
    """The statements of the program, in `main()` or at the end of the file."""

    body: Sequence[ast.stmt]
    function: Function | None


def whole_program(file: NodeFile, *, threads: bool = False) -> list[Edit]:
    """The whole program: what puts the node together is kept, and what spins and ends it is written as it should be.

    `threads`: by several threads; else by the executor that the file makes, if it makes one. Empty where there is no
    such program, or no node for it.
    """
    scope = _scope(file)
    if scope is None:
        return []
    kept = list(_kept(file, scope.body))
    same = takewhile(lambda pair: pair[0] is pair[1], zip(scope.body, kept, strict=False))
    prefix = [each for each, _ in same]
    rest = scope.body[len(prefix) :]
    lines = [_code(file, each) for each in kept[len(prefix) :]]
    nodes, made = _nodes(file, kept)
    if not nodes:
        return []
    setup = [] if _initialised(file, kept) else ["rclpy.init()"]
    ends = [waking for each in file.calls("set") if (waking := _waking(file, scope, each))]
    spinning, edits = _spinning(file, nodes, threads)
    both, imported = _both(file)
    code = [
        *setup,
        *lines,
        *made,
        *spinning[:-1],
        "try:",
        f"    {spinning[-1]}",
        f"{both}:",
        "    pass",
        "finally:",
        *(f"    {each}" for each in ends),
        "    rclpy.try_shutdown()",
    ]
    edits = [*_imported(file), *edits, *imported, *_started(file, scope)]
    if not rest:
        last = scope.body[-1]
        return [*edits, insert_after(last, "\n".join(code))]
    first, last = rest[0], rest[-1]
    if first.lineno == (prefix[-1].end_lineno if prefix else scope.function.lineno if scope.function else 0):
        return []
    return [*edits, Edit(first.lineno, last.end_lineno or last.lineno, "\n".join(code), like=first.lineno)]


def clean_ending(file: NodeFile) -> list[Edit]:
    """The whole program, and nothing beside it that keeps the process from ending."""
    whole = whole_program(file)
    beside = [
        each for each in _free(file) if not any(one.first <= each.first and each.last <= one.last for one in whole)
    ]
    return [*beside, *whole]


def guard_spin(file: NodeFile, call: ast.Call) -> list[Edit]:
    """A statement that spins, with what ends a spin caught around it, and rclpy shut down at last."""
    statement = file.statement(call)
    if not isinstance(statement, ast.Expr):
        return []
    both, imported = _both(file)
    end = "" if file.calls("try_shutdown", "shutdown") else "\nfinally:\n    rclpy.try_shutdown()"
    body = textwrap.indent(_code(file, statement), "    ")
    code = f"try:\n{body}\n{both}:\n    pass{end}"
    return [*imported, replace_statement(statement, code)]


def call_main(file: NodeFile) -> list[Edit]:
    """The call of main() at the end of the file, where nothing calls it."""
    main = next((each for each in file.tree.body if isinstance(each, Function) and each.name == "main"), None)
    return _called(file, main) if main is not None else []


def _called(file: NodeFile, main: Function) -> list[Edit]:
    code = f'if __name__ == "__main__":\n    {main.name}()'
    for each in file.tree.body:
        if isinstance(each, ast.If) and "__name__" in ast.unparse(each.test):
            return [replace_statement(each, code)]
        if isinstance(each, ast.Expr) and ast.unparse(each.value) == main.name:
            return [replace_statement(each, f"{main.name}()")]
    last = file.tree.body[-1]
    return [insert_below(last.end_lineno or last.lineno, f"\n\n{code}", like=main.lineno)]


def _started(file: NodeFile, scope: _Scope) -> list[Edit]:
    """The call of the program's function, once: where it is called in a loop, or not at all."""
    main = scope.function
    if main is None or main not in file.tree.body:
        return []
    calls = [each for each in file.calls(main.name) if not isinstance(each.func, ast.Attribute)]
    if any(not isinstance(each, ast.While | ast.For | Function) for call in calls for each in file.ancestors(call)):
        looped = [each for call in calls for each in file.ancestors(call) if isinstance(each, ast.While | ast.For)]
        return _called(file, main) if looped else []
    return _called(file, main)


def _free(file: NodeFile) -> list[Edit]:
    """Nothing else keeps the process from ending: threads are daemons, and Ctrl+C and the end are left to rclpy."""
    found = []
    for each in file.calls("Thread", "Timer"):
        if not any(given.arg == "daemon" for given in each.keywords) and called_name(each) == "Thread":
            found.append(_with_daemon(file, each))
    for each in file.calls("signal", "register"):
        statement = file.statement(each)
        if isinstance(statement, ast.Expr) and ast.unparse(each.func) in ("signal.signal", "atexit.register"):
            found.append(replace_statement(statement, "pass"))
    return found


def _with_daemon(file: NodeFile, call: ast.Call) -> Edit:
    statement = file.statement(call)
    first, last = statement.lineno, statement.end_lineno or statement.lineno
    lines = file.text.splitlines()
    end = (call.end_col_offset or 1) - 1
    row = (call.end_lineno or call.lineno) - 1
    line = lines[row].encode()
    comma = "" if line[:end].rstrip().endswith((b",", b"(")) or not line[:end].strip() else ", "
    lines[row] = line[:end].decode() + f"{comma}daemon=True" + line[end:].decode()
    return Edit(first, last, textwrap.dedent("\n".join(lines[first - 1 : last])), like=first)


def _scope(file: NodeFile) -> _Scope | None:
    """Where the program is: around rclpy.init(), or what spins or makes the node, outside of the node's class."""
    inits = [each for each in file.calls("init") if ast.unparse(each.func) in ("rclpy.init", "init")]
    making = file.calls(*file.node_classes, "create_node", "Node")
    for each in [*inits, *file.calls(*SPINS), *making]:
        function = file.function_around(each)
        if function is None:
            return _outside(file, each)
        if file.class_of(function) is None and not isinstance(function, ast.AsyncFunctionDef):
            return _Scope(function.body, function)
    main = next((each for each in file.functions if each.name == "main" and file.class_of(each) is None), None)
    return _Scope(main.body, main) if main is not None else None


def _outside(file: NodeFile, call: ast.Call) -> _Scope | None:
    around = [each for each in file.ancestors(call) if isinstance(each, ast.stmt)]
    if any(isinstance(each, ast.ClassDef) for each in around):
        return None
    outermost = around[-1] if around else file.statement(call)
    if isinstance(outermost, ast.If) and "__name__" in ast.unparse(outermost.test):
        return _Scope(outermost.body, None)
    return _Scope(file.tree.body[file.tree.body.index(outermost) :], None)


def _kept(file: NodeFile, body: Sequence[ast.stmt]) -> Iterator[ast.stmt]:
    """What puts the node together, of all that stands in a program before it spins."""
    gone: set[str] = set()
    for each in _flat(body):
        if isinstance(each, ast.ClassDef):
            yield each
            continue
        calls = calls_in(each)
        read = {inner.id for inner in ast.walk(each) if isinstance(inner, ast.Name) and isinstance(inner.ctx, ast.Load)}
        out = isinstance(each, ast.While | ast.For | ast.Return | ast.Raise | ast.Pass)
        out = out or any(_ends(call) for call in calls) or bool(read & gone) or _only_does(file, each)
        if not out:
            yield each
            continue
        if isinstance(each, Function):
            gone.add(each.name)
        gone |= {
            inner.id for inner in ast.walk(each) if isinstance(inner, ast.Name) and isinstance(inner.ctx, ast.Store)
        }
        if any(called_name(call) in SPINS for call in calls) and not isinstance(each, Function):
            return


def _only_does(file: NodeFile, statement: ast.stmt) -> bool:
    """Whether it calls a function that makes nothing of a node's, and keeps nothing of it."""
    if not isinstance(statement, ast.Expr) or not isinstance(call := statement.value, ast.Call):
        return False
    led = file.function(call.func)
    inside = [call, *(each for one in (file.reached(led) if led else []) for each in ast.walk(one))]
    names = [called_name(each) for each in inside if isinstance(each, ast.Call)]
    return not any(name.startswith(("create_", "declare_", "init", "add_on")) for name in names)


def _ends(call: ast.Call) -> bool:
    """Whether a call belongs to what is rewritten; a thread's target is what it may spin in."""
    return called_name(call) in _REPLACED or any(
        ast.unparse(each).rpartition(".")[2] in SPINS for each in (*call.args, *(k.value for k in call.keywords))
    )


def _flat(body: Sequence[ast.stmt]) -> Iterator[ast.stmt]:
    for each in body:
        if isinstance(each, ast.Try | ast.With):
            yield from _flat(each.body)
        else:
            yield each


def _nodes(file: NodeFile, kept: Sequence[ast.stmt]) -> tuple[list[str], list[str]]:
    """What the nodes are called, and the lines that make those that have no name yet."""
    classes = file.node_classes
    makers = (*classes, "create_node", "Node")
    names = [
        name
        for each in kept
        if isinstance(each, ast.Assign | ast.AnnAssign) and isinstance(each.value, ast.Call)
        if called_name(each.value) in makers and (name := file.assigned_to(each.value))
    ]
    if names:
        return names, []
    calls = [each for each in file.calls(*makers) if not _of_class(file, each)]
    unnamed = [ast.unparse(each) for each in calls] or [f"{each}()" for each in classes[-1:]]
    called_so = ["node"] if len(unnamed) == 1 else [f"node{number}" for number in range(1, len(unnamed) + 1)]
    return called_so, [f"{name} = {code}" for name, code in zip(called_so, unnamed, strict=True)]


def _spinning(file: NodeFile, nodes: Sequence[str], threads: bool) -> tuple[list[str], list[Edit]]:
    """The lines that run the nodes' callbacks, the one that spins last."""
    made = next(iter(file.calls("MultiThreadedExecutor")), None)
    if not threads and made is None and len(nodes) == 1:
        return [f"rclpy.spin({nodes[0]})"], []
    name, edits = file.own("MultiThreadedExecutor", "rclpy.executors")
    executor = (file.assigned_to(made) if made is not None else "") or "executor"
    code = f"{name}(num_threads={_THREADS})" if threads or made is None else ast.unparse(made)
    return [f"{executor} = {code}", *(f"{executor}.add_node({each})" for each in nodes), f"{executor}.spin()"], edits


def _both(file: NodeFile) -> tuple[str, list[Edit]]:
    name, edits = file.own("ExternalShutdownException", "rclpy.executors")
    return f"except (KeyboardInterrupt, {name})", edits


def _initialised(file: NodeFile, kept: Sequence[ast.stmt]) -> bool:
    """Whether what is kept initialises rclpy, or something outside of the program does."""
    inits = [each for each in file.calls("init") if ast.unparse(each.func) in ("rclpy.init", "init")]
    inside = [each for one in kept for each in ast.walk(one)]
    return any(each in inside or _of_class(file, each) for each in inits)


def _of_class(file: NodeFile, node: ast.AST) -> bool:
    return any(isinstance(each, ast.ClassDef) for each in file.ancestors(node))


def _imported(file: NodeFile) -> list[Edit]:
    """The import of rclpy itself, which try_shutdown() needs."""
    names = {alias.asname or alias.name.split(".")[0] for each, alias in file.imports if isinstance(each, ast.Import)}
    return [] if "rclpy" in names else add_import(file.text, "import rclpy")


def _waking(file: NodeFile, scope: _Scope, call: ast.Call) -> str:
    """What sets an event when the program ends, as it is written."""
    statement = file.statement(call)
    if not isinstance(statement, ast.Expr) or not any(statement in ast.walk(each) for each in scope.body):
        return ""
    return (
        ast.unparse(statement)
        if statement.value is call and not call.args and file.function_around(call) is scope.function
        else ""
    )


def _code(file: NodeFile, statement: ast.stmt) -> str:
    lines = file.text.splitlines()[first_line(statement) - 1 : statement.end_lineno]
    code = textwrap.dedent("\n".join(lines))
    try:
        alone = len(ast.parse(code).body) == 1
    except SyntaxError:
        alone = False
    return code if alone else ast.unparse(statement)


def first_sound_step(trace: Trace, *edits: Callable[[NodeFile], Sequence[Edit]], name: str = "") -> str | None:
    """The first of these edits that leaves a file which Python can run, in words; usually of the one that was started.

    `name`: the file's, where it is another one.
    """
    name = name or trace.file
    file = node_file(trace.sources.get(name, ""))
    found = file.step(*(each(file) for each in edits)) if file.tree.body else None
    return f"in {name}, {found}" if found and len(trace.sources) > 1 else found
