"""Rewrite the program around a learner's node: the code that creates it, spins it, and exits on Ctrl+C."""

from __future__ import annotations

import ast
import textwrap
from collections.abc import Callable, Sequence
from itertools import takewhile

from tutor.judge.edits import Edit, add_import, insert_after, insert_below, replace_node, replace_statement
from tutor.judge.rewriting.node import NodeFile, first_line, node_file
from tutor.judge.rewriting.program_scope import Scope, find_scope, setup_statements
from tutor.judge.source import Function, SourceFile, called_name, calls_in, last_name
from tutor.judge.syntax_tree import parse
from tutor.judge.trace import Trace

_THREADS = 8


def whole_program(file: NodeFile, *, threads: bool = False) -> list[Edit]:
    """Rewrite the whole program: keep what sets the node up, and write spinning and exit as they should be.

    `threads`: spin in several threads; otherwise, with the executor that the file creates, if any. No edits if there is
    no such program, or no node in it.
    """
    scope = find_scope(file)
    if scope is None:
        return []
    kept = list(setup_statements(file, scope.body))
    same = takewhile(lambda pair: pair[0] is pair[1], zip(scope.body, kept, strict=False))
    prefix = [each for each, _ in same]
    rest = scope.body[len(prefix) :]
    lines = [code_of(file, each) for each in kept[len(prefix) :]]
    nodes, created = _name_nodes(file, kept)
    if not nodes:
        return []
    init = [] if _is_initialised(file, kept) else ["rclpy.init()"]
    ends = [setting for each in file.calls("set") if (setting := _event_set_at_end(file, scope, each))]
    spin, edits = _spin_lines(file, nodes, threads)
    except_line, imported = _except_interrupt(file)
    code = [
        *init,
        *lines,
        *created,
        *spin[:-1],
        "try:",
        f"    {spin[-1]}",
        f"{except_line}:",
        "    pass",
        "finally:",
        *(f"    {each}" for each in ends),
        "    rclpy.try_shutdown()",
    ]
    edits = [*_import_rclpy(file), *edits, *imported, *_call_once(file, scope)]
    if not rest:
        last = scope.body[-1]
        return [*edits, insert_after(last, "\n".join(code))]
    first, last = rest[0], rest[-1]
    if first.lineno == (prefix[-1].end_lineno if prefix else scope.function.lineno if scope.function else 0):
        return []
    return [*edits, Edit(first.lineno, last.end_lineno or last.lineno, "\n".join(code), like=first.lineno)]


def clean_ending(file: NodeFile) -> list[Edit]:
    """Rewrite the whole program, and remove everything else that keeps the process from ending."""
    whole = whole_program(file)
    others = [
        each
        for each in _remove_obstacles(file)
        if not any(one.first <= each.first and each.last <= one.last for one in whole)
    ]
    return [*others, *whole]


def guard_spin(file: NodeFile, call: ast.Call) -> list[Edit]:
    """Catch around a spin the exceptions that end it, and shut rclpy down afterwards."""
    statement = file.statement(call)
    if not isinstance(statement, ast.Expr):
        return []
    except_line, imported = _except_interrupt(file)
    end = "" if file.calls("try_shutdown", "shutdown") else "\nfinally:\n    rclpy.try_shutdown()"
    body = textwrap.indent(code_of(file, statement), "    ")
    code = f"try:\n{body}\n{except_line}:\n    pass{end}"
    return [*imported, replace_statement(statement, code)]


def call_main(file: NodeFile) -> list[Edit]:
    """Add the missing call of main() at the end of the file."""
    main = next((each for each in file.tree.body if isinstance(each, Function) and each.name == "main"), None)
    return _add_main_call(file, main) if main is not None else []


def _add_main_call(file: NodeFile, main: Function) -> list[Edit]:
    code = f'if __name__ == "__main__":\n    {main.name}()'
    for each in file.tree.body:
        if isinstance(each, ast.If) and "__name__" in ast.unparse(each.test):
            return [replace_statement(each, code)]
        if isinstance(each, ast.Expr) and ast.unparse(each.value) == main.name:
            return [replace_statement(each, f"{main.name}()")]
    last = file.tree.body[-1]
    return [insert_below(last.end_lineno or last.lineno, f"\n\n{code}", like=main.lineno)]


def _call_once(file: NodeFile, scope: Scope) -> list[Edit]:
    """Call the program's function once, if it is called in a loop or not at all."""
    main = scope.function
    if main is None or main not in file.tree.body:
        return []
    calls = [each for each in file.calls(main.name) if not isinstance(each.func, ast.Attribute)]
    if any(not isinstance(each, ast.While | ast.For | Function) for call in calls for each in file.ancestors(call)):
        looped = [each for call in calls for each in file.ancestors(call) if isinstance(each, ast.While | ast.For)]
        return _add_main_call(file, main) if looped else []
    return _add_main_call(file, main)


def _remove_obstacles(file: NodeFile) -> list[Edit]:
    """Let the process end: turn threads into daemons, and leave Ctrl+C and the exit to rclpy."""
    found = make_daemons(file)
    for each in file.calls("signal", "register"):
        statement = file.statement(each)
        if isinstance(statement, ast.Expr) and ast.unparse(each.func) in ("signal.signal", "atexit.register"):
            found.append(replace_statement(statement, "pass"))
    return found


def make_daemons(file: NodeFile) -> list[Edit]:
    """Turn all threads that the file makes into daemons, except for those that say what they are.

    Those of a pool that are kept busy for ever become threads of their own.
    """
    made = [*file.calls("Thread"), *_thread_subclasses(file)]
    return [
        *(make_daemon(file, each) for each in made if not any(given.arg == "daemon" for given in each.keywords)),
        *_take_endless_work_from_pool(file),
    ]


def _take_endless_work_from_pool(file: NodeFile) -> list[Edit]:
    """Start a daemon for each function with an endless loop that is submitted to a pool of threads."""
    found: list[Edit] = []
    for call in file.calls("submit"):
        work = file.function(call.args[0]) if call.args and not call.keywords else None
        if work is None or not any(isinstance(each, ast.While) and _is_endless(each) for each in ast.walk(work)):
            continue
        if isinstance(statement := file.statement(call), ast.Expr) and statement.value is call:
            name, imported = file.import_name("Thread", "threading")
            given = "".join(f"{ast.unparse(each)}, " for each in call.args[1:])
            arguments = f"args=({given.rstrip()}), " if given else ""
            code = f"{name}(target={ast.unparse(call.args[0])}, {arguments}daemon=True).start()"
            found += [*imported, replace_statement(statement, code)]
    return list(dict.fromkeys(found))


def _is_endless(loop: ast.While) -> bool:
    return ast.unparse(loop.test) in ("True", "1") and not any(
        isinstance(each, ast.Break | ast.Return) for each in ast.walk(loop)
    )


def _thread_subclasses(file: NodeFile) -> list[ast.Call]:
    """The calls by which subclasses of Thread initialize it."""
    classes = [each for each in file.nodes if isinstance(each, ast.ClassDef) and "Thread" in map(last_name, each.bases)]
    return [call for each in classes for call in calls_in(each, "__init__")]


def make_daemon(file: SourceFile, call: ast.Call) -> Edit:
    """Turn the thread that this call makes into a daemon, for whose end Python does not wait."""
    if (given := next((each.value for each in call.keywords if each.arg == "daemon"), None)) is not None:
        return replace_node(file.text, given, "True")
    statement = file.statement(call)
    first, last = statement.lineno, statement.end_lineno or statement.lineno
    lines = file.text.splitlines()
    end = (call.end_col_offset or 1) - 1
    row = (call.end_lineno or call.lineno) - 1
    line = lines[row].encode()
    before = line[:end].decode()
    if before.strip():
        before += "" if before.rstrip().endswith((",", "(")) else ", "
    elif not lines[row - 1].rstrip().endswith((",", "(")):
        lines[row - 1] = f"{lines[row - 1].rstrip()},"
    lines[row] = f"{before}daemon=True{line[end:].decode()}"
    return Edit(first, last, textwrap.dedent("\n".join(lines[first - 1 : last])), like=first)


def _name_nodes(file: NodeFile, kept: Sequence[ast.stmt]) -> tuple[list[str], list[str]]:
    """The names of the nodes, and the lines that create those that are not assigned to a name yet."""
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
    calls = [each for each in file.calls(*makers) if not _is_in_class(file, each)]
    unnamed = [ast.unparse(each) for each in calls] or [f"{each}()" for each in classes[-1:]]
    new_names = ["node"] if len(unnamed) == 1 else [f"node{number}" for number in range(1, len(unnamed) + 1)]
    return new_names, [f"{name} = {code}" for name, code in zip(new_names, unnamed, strict=True)]


def _spin_lines(file: NodeFile, nodes: Sequence[str], threads: bool) -> tuple[list[str], list[Edit]]:
    """The lines that run the nodes' callbacks, the spin itself last, and the imports that they need."""
    made = next(iter(file.calls("MultiThreadedExecutor")), None)
    if not threads and made is None and len(nodes) == 1:
        return [f"rclpy.spin({nodes[0]})"], []
    name, edits = file.import_name("MultiThreadedExecutor", "rclpy.executors")
    executor = (file.assigned_to(made) if made is not None else "") or "executor"
    code = f"{name}(num_threads={_THREADS})" if threads or made is None else ast.unparse(made)
    return [f"{executor} = {code}", *(f"{executor}.add_node({each})" for each in nodes), f"{executor}.spin()"], edits


def _except_interrupt(file: NodeFile) -> tuple[str, list[Edit]]:
    """The `except` clause, without its colon, for both exceptions that end a spin, and the imports that it needs."""
    name, edits = file.import_name("ExternalShutdownException", "rclpy.executors")
    return f"except (KeyboardInterrupt, {name})", edits


def _is_initialised(file: NodeFile, kept: Sequence[ast.stmt]) -> bool:
    """Whether the kept statements initialise rclpy, or a class does."""
    inits = [each for each in file.calls("init") if ast.unparse(each.func) in ("rclpy.init", "init")]
    inside = [each for one in kept for each in ast.walk(one)]
    return any(each in inside or _is_in_class(file, each) for each in inits)


def _is_in_class(file: NodeFile, node: ast.AST) -> bool:
    return any(isinstance(each, ast.ClassDef) for each in file.ancestors(node))


def _import_rclpy(file: NodeFile) -> list[Edit]:
    """Import rclpy itself, which rclpy.try_shutdown() needs."""
    names = {alias.asname or alias.name.split(".")[0] for each, alias in file.imports if isinstance(each, ast.Import)}
    return [] if "rclpy" in names else add_import(file.text, "import rclpy")


def _event_set_at_end(file: NodeFile, scope: Scope, call: ast.Call) -> str:
    """The program's own statement that sets an event, typically to wake a thread at the end; empty if it is none."""
    statement = file.statement(call)
    if not isinstance(statement, ast.Expr) or not any(statement in ast.walk(each) for each in scope.body):
        return ""
    return (
        ast.unparse(statement)
        if statement.value is call and not call.args and file.function_around(call) is scope.function
        else ""
    )


def code_of(file: NodeFile, statement: ast.stmt) -> str:
    """A statement as written, dedented; if it shares its lines with other code, as unparsed."""
    lines = file.text.splitlines()[first_line(statement) - 1 : statement.end_lineno]
    code = textwrap.dedent("\n".join(lines))
    try:
        is_alone = len(parse(code).body) == 1
    except SyntaxError:
        is_alone = False
    return code if is_alone else ast.unparse(statement)


def first_sound_step(trace: Trace, *edits: Callable[[NodeFile], Sequence[Edit]], name: str = "") -> str | None:
    """The first of these rewrites that leaves a sound file, in words; None if none does.

    `name`: the file to edit, by default the one that was run.
    """
    name = name or trace.file
    file = node_file(trace.sources.get(name, ""))
    found = file.step(*(each(file) for each in edits)) if file.tree.body else None
    return f"in {name}, {found}" if found and len(trace.sources) > 1 else found
