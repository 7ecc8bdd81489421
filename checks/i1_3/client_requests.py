"""I1.3: edits of the client's code by which each request is waited for, before and after, and all four are made."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from checks.i1_3.code import Code
from checks.i1_3.services import Changes
from tutor.judge import edits, source
from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import argument
from tutor.judge.source import Function
from tutor.judge.trace import Trace

LONG = "wait_for_service(timeout_sec=10.0)"
_READY = "service_is_ready", "server_is_ready"
_SPINS = "spin_until_future_complete", "spin_once_until_future_complete"


def find_requests(code: Code, *names: str) -> list[tuple[ast.Call, str]]:
    """The calls by which requests are sent, with the service client that they are sent by."""
    found = []
    for call in code.calls(*(names or ("call_async", "call"))):
        if isinstance(call.func, ast.Attribute) and len(call.args) == 1 and not code.named(call.func.attr):
            client = ast.unparse(call.func.value)
            if client not in ("subprocess", "self", "super()"):
                found.append((call, client))
    return found


def wait_for_services(code: Code) -> str | None:
    """The step that waits for each service: right above its requests, else where its client is made."""
    above = []
    for call, client in find_requests(code):
        statement = code.statement(call)
        if "(" not in client and not any(isinstance(each, ast.Lambda) for each in code.ancestors(call)):
            above.append(edits.insert_above(statement.lineno, f"{client}.{LONG}"))
    above = list(dict.fromkeys(above))
    whole = len({code.statement(call).lineno for call, _ in find_requests(code)}) == len(above)
    if above and whole and not _stands(code, above) and (step := code.as_step(above)) is not None:
        return step
    made = code.calls("create_client")
    if not made or code.named("waited"):
        return None
    lines = ["def waited(client):", f"    client.{LONG}", "    return client", ""]
    swaps: list[tuple[ast.expr, str]] = [(each, f"waited({ast.unparse(each)})") for each in made]
    return Changes(code, swaps, [edits.insert_above(code.first.lineno, "\n".join(lines))]).as_step()


def _stands(code: Code, above: Sequence[Edit]) -> bool:
    """Whether each of the lines stands where it would be written already."""
    lines = code.text.splitlines()
    return all(lines[each.first - 2].strip() == each.code for each in above)


def lengthen_waits(code: Code) -> str | None:
    """The step by which each wait for a service takes long enough."""
    swaps: list[tuple[ast.expr, str]] = []
    for call in code.calls("wait_for_service", *_READY):
        if isinstance(call.func, ast.Attribute):
            new = f"{ast.unparse(call.func.value)}.{LONG}"
            if new != ast.unparse(call):
                swaps.append((call, new))
    if swaps:
        return Changes(code, swaps).as_step()
    return None if code.calls("wait_for_service") else wait_for_services(code)


def wait_for_answers(code: Code, trace: Trace) -> str | None:
    """The step that waits for the answer to each request, where nothing does."""
    held = [name for each in ("create_timer", "create_subscription") for name in source.callbacks(trace, each)]
    callbacks = {each.name for each in held}
    if any((function := code.function_around(call)) and function.name in callbacks for call, _ in find_requests(code)):
        return _awaited(code, callbacks)
    change = Changes(code, more=code.importing("rclpy"))
    for call, client in find_requests(code):
        _answer(code, call, client, change)
    return change.as_step() if change.swaps or len(change.more) > len(code.importing("rclpy")) else None


def _answer(code: Code, call: ast.Call, client: str, change: Changes) -> None:
    statement, parent = code.statement(call), next(code.ancestors(call))
    assert isinstance(call.func, ast.Attribute)
    if isinstance(statement, ast.Assign) and statement.value is call and call.func.attr == "call_async":
        _answer_to(code, statement, ast.unparse(statement.targets[0]), change)
        return
    if call.func.attr == "call_async" and isinstance(parent, ast.Await):
        return
    if call.func.attr == "call_async" and isinstance(parent, ast.Attribute) and parent.attr == "add_done_callback":
        return
    if call.func.attr == "call_async" and isinstance(statement, ast.Return) and code.calls(*_SPINS):
        return
    if not isinstance(statement, ast.Expr | ast.Assign | ast.AnnAssign | ast.Return | ast.AugAssign):
        return
    asked = f"future = {client}.call_async({ast.unparse(call.args[0])})"
    wait = f"{_spin(code)}({code.node(call)}, future)"
    change.more.append(edits.insert_above(statement.lineno, f"{asked}\n{wait}"))
    whole: ast.expr = call
    if call.func.attr == "call_async" and isinstance(parent, ast.Attribute) and parent.attr == "result":
        outer = next(code.ancestors(parent))
        whole = outer if isinstance(outer, ast.Call) else call
    change.swaps.append((whole, "future.result()"))


def _answer_to(code: Code, asked: ast.Assign, future: str, change: Changes) -> None:
    """A wait for one future, right below its request, or in place of what does not wait."""
    function = code.function_around(asked)
    inside = list(ast.walk(function)) if function is not None else code.nodes
    own = future.rpartition(".")[2]
    uses = [ast.unparse(each) for call in code.calls(*_SPINS, "gather", "add_done_callback") for each in _of(call)]
    if any(each.rpartition(".")[2] == own for each in uses):
        return
    if any(isinstance(each, ast.Await) and ast.unparse(each.value) == future for each in inside):
        return
    wait = f"{_spin(code)}({code.node(asked)}, {future})"
    for each in inside:
        if isinstance(each, ast.While) and f"{future}.done()" in ast.unparse(each.test):
            if any(isinstance(part, ast.Call) and "spin" in source.called_name(part) for part in ast.walk(each)):
                return
            change.more.append(edits.replace_statement(each, wait))
            return
    once = [each for each in code.calls("spin_once") if code.function_around(each) is function]
    if once and code.statement(once[0]).lineno == once[0].lineno and not code.loop(once[0], asked):
        change.swaps.append((once[0], wait))
    elif not code.calls(*_SPINS) or f"{future}.result()" in ast.unparse(function or ast.Module(list(code.top), [])):
        change.more.append(edits.insert_after(asked, wait))
        returned = [each for each in inside if isinstance(each, ast.Return) and each.value is not None]
        for each in returned:
            if each.value is not None and ast.unparse(each.value) == future and ".result(" not in code.text:
                change.swaps.append((each.value, f"{future}.result()"))


def set_event(code: Code, line: int) -> str | None:
    """The step by which an answer ends the wait for an event on this line (1-based), where nothing sets the event."""
    wait = next((call for call in code.calls("wait") if call.lineno == line), None)
    if wait is None or not isinstance(wait.func, ast.Attribute):
        return None
    event = ast.unparse(wait.func.value)
    made = next((call for call in code.calls("Event") if code.assigned_to(call) == event), None)
    asked = [(call, future) for call, _ in find_requests(code, "call_async") if (future := code.assigned_to(call))]
    if made is None or not asked or _is_set(code, event):
        return None
    if not code.calls("Thread"):  # nothing takes the answer in while this thread waits
        beside = [each for each in asked if code.function_around(each[0]) is code.function_around(wait)]
        if len(beside) != 1:
            return None
        spin = f"{_spin(code)}({code.node(wait)}, {beside[0][1]})"
        return code.as_step(edits.replace_statement(code.statement(wait), spin), code.importing("rclpy"))
    changes = []
    for call, future in asked:
        statement, callback = code.statement(call), f"{future}.add_done_callback(lambda _: {event}.set())"
        fresh = next(code.ancestors(statement)) is next(code.ancestors(code.statement(made)))  # made for each request
        changes.append(edits.insert_after(statement, callback if fresh else f"{event}.clear()\n{callback}"))
    return code.as_step(changes)


def _is_set(code: Code, event: str) -> bool:
    """Whether something sets an event of this name, or of its last part (`self.answered`, `client.answered`)."""
    name = event.rpartition(".")[2]
    setters = (each.value for each in code.nodes if isinstance(each, ast.Attribute) and each.attr == "set")
    return any(ast.unparse(each).rpartition(".")[2] == name for each in setters)


def _of(call: ast.Call) -> Iterator[ast.expr]:
    yield from call.args
    yield from (each.value for each in call.keywords)
    if isinstance(call.func, ast.Attribute):
        yield call.func.value


def _spin(code: Code) -> str:
    return f"{code.imported('rclpy')}.spin_until_future_complete"


def _awaited(code: Code, callbacks: set[str]) -> str | None:
    """The step for requests of a callback: it awaits them, and the answers come in beside it."""
    asking = {
        id(f): f
        for call, _ in find_requests(code)
        if (f := code.function_around(call)) is not None and f.name in callbacks
    }
    names = {each.name for each in asking.values()}
    while more := [f for f in _callers(code, names) if f.name in callbacks and id(f) not in asking]:
        asking |= {id(each): each for each in more}
        names |= {each.name for each in more}
    change = Changes(code, more=code.importing("ReentrantCallbackGroup"))
    for function in asking.values():
        if isinstance(function, ast.FunctionDef):
            line = code.text.splitlines()[function.lineno - 1].strip()
            change.more.append(edits.replace_lines(function.lineno, f"async {line}"))
    for call, client in find_requests(code):
        if id(code.function_around(call)) not in asking or isinstance(next(code.ancestors(call)), ast.Await):
            continue
        assert isinstance(call.func, ast.Attribute)
        if call.func.attr == "call":
            change.swaps.append((call, f"(await {client}.call_async({ast.unparse(call.args[0])}))"))
    for call in code.calls(*_SPINS):
        if id(code.function_around(call)) in asking and (future := argument(call, 1, "future")) is not None:
            change.swaps.append((call, f"await {ast.unparse(future)}"))
    for call in code.calls(*names):
        if id(code.function_around(call)) in asking and not isinstance(next(code.ancestors(call)), ast.Await):
            change.swaps.append((call, f"(await {ast.unparse(call)})"))
    for call in code.calls("create_client"):
        if not any(each.arg == "callback_group" for each in call.keywords):
            whole = ast.unparse(call)
            change.swaps.append((call, f"{whole[:-1]}, callback_group=ReentrantCallbackGroup())"))
    return change.as_step()


def _callers(code: Code, names: set[str]) -> Iterator[Function]:
    for call in code.calls(*names):
        if (function := code.function_around(call)) is not None:
            yield function


def make_synchronous(code: Code, name: str) -> str | None:
    """The step by which a coroutine that nobody runs becomes an ordinary function."""
    change = Changes(code)
    for function in code.named(name):
        line = code.text.splitlines()[function.lineno - 1].strip()
        change.more.append(edits.replace_lines(function.lineno, line.removeprefix("async ")))
        for each in ast.walk(function):
            if isinstance(each, ast.Await):
                asked = ast.unparse(each.value)
                future = asked if asked.isidentifier() else "future"
                first = [] if future == asked else [f"future = {asked}"]
                wait = f"{_spin(code)}({code.node(each)}, {future})"
                change.more.append(edits.insert_above(code.statement(each).lineno, "\n".join([*first, wait])))
                change.swaps.append((each, f"{future}.result()"))
    return change.as_step()
