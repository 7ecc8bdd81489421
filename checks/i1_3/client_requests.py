"""I1.3: steps that make the client wait for each service before its request, and for each answer after it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from checks.i1_3.code import Code
from checks.i1_3.services import Changes
from tutor.judge import edits, source
from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import argument
from tutor.judge.source import Function
from tutor.judge.trace import Trace

WAIT_FOR_SERVICE = "wait_for_service(timeout_sec=10.0)"
_READY = "service_is_ready", "server_is_ready"
_SPINS = "spin_until_future_complete", "spin_once_until_future_complete"

_FUTURE_USES = re.compile("done|result|future|spin|wait|gather")
"""Calls with names like these take a future, or are methods of one."""


def find_requests(code: Code, *names: str) -> list[tuple[ast.Call, str]]:
    """Find the calls that send requests, each with the source of its service client."""
    found = []
    for call in code.calls(*(names or ("call_async", "call"))):
        if isinstance(call.func, ast.Attribute) and len(call.args) == 1 and not code.functions_named(call.func.attr):
            client = ast.unparse(call.func.value)
            if client not in ("subprocess", "self", "super()"):
                found.append((call, client))
    return found


def wait_for_services(code: Code) -> str | None:
    """Step: wait for each service, right above its requests or else where its client is created."""
    above = []
    for call, client in find_requests(code):
        statement = code.statement(call)
        if "(" not in client and not any(isinstance(each, ast.Lambda) for each in code.ancestors(call)):
            above.append(edits.insert_above(statement.lineno, f"{client}.{WAIT_FOR_SERVICE}"))
    above = list(dict.fromkeys(above))
    covers_all = len({code.statement(call).lineno for call, _ in find_requests(code)}) == len(above)
    if above and covers_all and not _are_present(code, above) and (step := code.as_step(above)) is not None:
        return step
    made = code.calls("create_client")
    if not made or code.functions_named("waited"):
        return None
    lines = ["def waited(client):", f"    client.{WAIT_FOR_SERVICE}", "    return client", ""]
    swaps: list[tuple[ast.expr, str]] = [(each, f"waited({ast.unparse(each)})") for each in made]
    return Changes(code, swaps, [edits.insert_above(code.first_statement.lineno, "\n".join(lines))]).as_step()


def _are_present(code: Code, above: Sequence[Edit]) -> bool:
    """Whether the file already has each of these lines where the edit would insert it."""
    lines = code.text.splitlines()
    return all(lines[each.first - 2].strip() == each.code for each in above)


def lengthen_waits(code: Code) -> str | None:
    """Step: give each wait for a service a long enough timeout."""
    swaps: list[tuple[ast.expr, str]] = []
    for call in code.calls("wait_for_service", *_READY):
        if isinstance(call.func, ast.Attribute):
            new = f"{ast.unparse(call.func.value)}.{WAIT_FOR_SERVICE}"
            if new != ast.unparse(call):
                swaps.append((call, new))
    if swaps:
        return Changes(code, swaps).as_step()
    return None if code.calls("wait_for_service") else wait_for_services(code)


def wait_for_answers(code: Code, trace: Trace) -> str | None:
    """Step: wait for the answer to each request that nothing waits for."""
    functions = [f for create in ("create_timer", "create_subscription") for f in source.callbacks(trace, create)]
    callbacks = {each.name for each in functions}
    if any((function := code.function_around(call)) and function.name in callbacks for call, _ in find_requests(code)):
        return _await_in_callbacks(code, callbacks)
    change = Changes(code, more=code.missing_imports("rclpy"))
    for call, client in find_requests(code):
        _wait_for_answer(code, call, client, change)
    for call in code.calls("result"):  # of rclpy's Future, which takes no timeout
        if call.args or call.keywords:
            change.swaps.append((call, f"{ast.unparse(call.func)}()"))
    return change.as_step() if change.swaps or len(change.more) > len(code.missing_imports("rclpy")) else None


_COMPREHENSIONS = ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp
_WAITS = "wait_for_service", "service_is_ready"


def negate_waits(code: Code) -> str | None:
    """Step: repeat a wait while the service is not there, in place of while it is."""
    tests = [each.test for each in code.nodes if isinstance(each, ast.While)]
    waits = [each for each in tests if isinstance(each, ast.Call) and source.called_name(each) in _WAITS]
    return code.as_step(edits.replace_nodes(code.text, *((each, f"not {ast.unparse(each)}") for each in waits)))


def spin_while_polling(code: Code) -> str | None:
    """Step: spin in each loop that polls a future, instead of sleeping, if nothing in the file spins."""
    if code.calls("spin", "spin_once", "spin_until_future_complete"):
        return None
    swaps = []
    loops = [
        next((each for each in code.ancestors(call) if isinstance(each, ast.While | ast.For)), None)
        for call in code.calls("done")
    ]
    for loop in dict.fromkeys(loops):
        if loop is not None:
            spin = f"{code.local_name('rclpy')}.spin_once({code.node_name(loop)}, timeout_sec=0.1)"
            sleeps = [each for each in source.calls_in(loop, "sleep") if isinstance(code.statement(each), ast.Expr)]
            swaps += [(each, spin) for each in sleeps[:1]]
    return code.as_step(edits.replace_nodes(code.text, *swaps), code.missing_imports("rclpy") if swaps else [])


def _wait_for_answer(code: Code, call: ast.Call, client: str, change: Changes) -> None:
    """Add to `change` a wait for the answer to one request, unless the code has one."""
    statement, parent = code.statement(call), next(code.ancestors(call))
    assert isinstance(call.func, ast.Attribute)
    if isinstance(statement, ast.Assign) and statement.value is call and call.func.attr == "call_async":
        _wait_for_future(code, statement, ast.unparse(statement.targets[0]), change)
        return
    if call.func.attr == "call_async" and isinstance(parent, ast.Await):
        return
    if call.func.attr == "call_async" and isinstance(parent, ast.Attribute) and parent.attr == "add_done_callback":
        return
    if call.func.attr == "call_async" and isinstance(statement, ast.Return) and code.calls(*_SPINS):
        return
    if not isinstance(statement, ast.Expr | ast.Assign | ast.AnnAssign | ast.Return | ast.AugAssign):
        return
    if any(isinstance(each, _COMPREHENSIONS) for each in code.ancestors(call)):
        return
    request = f"future = {client}.call_async({ast.unparse(call.args[0])})"
    wait = f"{_spin_function(code)}({code.node_name(call)}, future)"
    if _spins_in_thread(code):
        wait = f"while not future.done():\n    {code.local_name('time')}.sleep(0.01)"
        change.more += [each for each in code.missing_imports("time") if each not in change.more]
    change.more.append(edits.insert_above(statement.lineno, f"{request}\n{wait}"))
    replaced: ast.expr = call
    if call.func.attr == "call_async" and isinstance(parent, ast.Attribute) and parent.attr == "result":
        outer = next(code.ancestors(parent))
        replaced = outer if isinstance(outer, ast.Call) else call
    is_future = isinstance(statement, ast.Return) and statement.value is call and _is_used_as_future(code, call)
    change.swaps.append((replaced, "future" if is_future else "future.result()"))


def _spins_in_thread(code: Code) -> bool:
    """Whether a thread spins: then the answer arrives by itself, and no other thread may spin the node."""
    for call in code.calls("Thread"):
        target = next((each.value for each in call.keywords if each.arg == "target"), None)
        function = code.function(target)
        reached = [each for one in (code.reachable_from(function) if function else []) for each in ast.walk(one)]
        called = [source.called_name(each) for each in reached if isinstance(each, ast.Call)]
        if "spin" in (source.last_name(target), *called):
            return True
    return False


def _is_used_as_future(code: Code, call: ast.Call) -> bool:
    """Whether a caller waits for what the function around `call` returns, or asks it for its result."""
    function = code.function_around(call)
    for each in code.calls(function.name) if function is not None else ():
        name, caller = code.assigned_to(each), code.function_around(each)
        inside = ast.walk(caller) if caller is not None else code.nodes
        waits = [
            other for other in inside if isinstance(other, ast.Call) and _FUTURE_USES.search(source.called_name(other))
        ]
        if name and any(ast.unparse(used) == name for other in waits for used in _inputs(other)):
            return True
    return False


def _wait_for_future(code: Code, request: ast.Assign, future: str, change: Changes) -> None:
    """Add to `change` a wait for one future, right below its request or in place of a loop or spin that falls short."""
    function = code.function_around(request)
    inside = list(ast.walk(function)) if function is not None else code.nodes
    name = future.rpartition(".")[2]
    uses = [ast.unparse(each) for call in code.calls(*_SPINS, "gather", "add_done_callback") for each in _inputs(call)]
    if any(each.rpartition(".")[2] == name for each in uses):
        return
    if any(isinstance(each, ast.Await) and ast.unparse(each.value) == future for each in inside):
        return
    wait = f"{_spin_function(code)}({code.node_name(request)}, {future})"
    for each in inside:
        if isinstance(each, ast.While) and f"{future}.done()" in ast.unparse(each.test):
            if any(isinstance(part, ast.Call) and "spin" in source.called_name(part) for part in ast.walk(each)):
                return
            change.more.append(edits.replace_statement(each, wait))
            return
    once = [each for each in code.calls("spin_once") if code.function_around(each) is function]
    if once and code.statement(once[0]).lineno == once[0].lineno and not code.is_in_inner_loop(once[0], request):
        change.swaps.append((once[0], wait))
    elif not code.calls(*_SPINS) or f"{future}.result()" in ast.unparse(function or ast.Module(list(code.top), [])):
        change.more.append(edits.insert_after(request, wait))
        returned = [each for each in inside if isinstance(each, ast.Return) and each.value is not None]
        for each in returned:
            if each.value is not None and ast.unparse(each.value) == future and ".result(" not in code.text:
                change.swaps.append((each.value, f"{future}.result()"))


def set_event(code: Code, line: int) -> str | None:
    """Step: let the answer end the wait on this line (1-based) for a threading event that nothing sets."""
    wait = next((call for call in code.calls("wait") if call.lineno == line), None)
    if wait is None or not isinstance(wait.func, ast.Attribute):
        return None
    event = ast.unparse(wait.func.value)
    made = next((call for call in code.calls("Event") if code.assigned_to(call) == event), None)
    requests = [(call, future) for call, _ in find_requests(code, "call_async") if (future := code.assigned_to(call))]
    if made is None or not requests or _is_set(code, event):
        return None
    if not code.calls("Thread"):  # no other thread spins to receive the answer while this one waits
        nearby = [each for each in requests if code.function_around(each[0]) is code.function_around(wait)]
        if len(nearby) != 1:
            return None
        spin = f"{_spin_function(code)}({code.node_name(wait)}, {nearby[0][1]})"
        return code.as_step(edits.replace_statement(code.statement(wait), spin), code.missing_imports("rclpy"))
    changes = []
    for call, future in requests:
        statement, callback = code.statement(call), f"{future}.add_done_callback(lambda _: {event}.set())"
        # An event created beside the request is a new one each time; any other has to be cleared first.
        is_new = next(code.ancestors(statement)) is next(code.ancestors(code.statement(made)))
        changes.append(edits.insert_after(statement, callback if is_new else f"{event}.clear()\n{callback}"))
    return code.as_step(changes)


def _is_set(code: Code, event: str) -> bool:
    """Whether something sets this event, matched by its last part: `self.answered` and `client.answered` are alike."""
    name = event.rpartition(".")[2]
    setters = (each.value for each in code.nodes if isinstance(each, ast.Attribute) and each.attr == "set")
    return any(ast.unparse(each).rpartition(".")[2] == name for each in setters)


def _inputs(call: ast.Call) -> Iterator[ast.expr]:
    """The arguments of a call, and the object that it is a method of."""
    yield from call.args
    yield from (each.value for each in call.keywords)
    if isinstance(call.func, ast.Attribute):
        yield call.func.value


def _spin_function(code: Code) -> str:
    return f"{code.local_name('rclpy')}.spin_until_future_complete"


def _await_in_callbacks(code: Code, callbacks: set[str]) -> str | None:
    """Step for requests from callbacks: await the answers, which arrive through a reentrant callback group."""
    asking = {
        id(f): f
        for call, _ in find_requests(code)
        if (f := code.function_around(call)) is not None and f.name in callbacks
    }
    names = {each.name for each in asking.values()}
    while more := [f for f in _callers(code, names) if f.name in callbacks and id(f) not in asking]:
        asking |= {id(each): each for each in more}
        names |= {each.name for each in more}
    change = Changes(code, more=code.missing_imports("ReentrantCallbackGroup"))
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
        given = next((each.value for each in call.keywords if each.arg == "callback_group"), None)
        if given is not None and not _is_reentrant(code, given):
            change.swaps.append((given, "ReentrantCallbackGroup()"))
        elif given is None:
            change.swaps.append((call, f"{ast.unparse(call)[:-1]}, callback_group=ReentrantCallbackGroup())"))
    return change.as_step()


def _is_reentrant(code: Code, group: ast.expr) -> bool:
    """Whether this expression is, or is assigned, a ReentrantCallbackGroup."""
    values = [group, *source.values_of(ast.unparse(group), code.tree)]
    return any(isinstance(each, ast.Call) and source.called_name(each) == "ReentrantCallbackGroup" for each in values)


def _callers(code: Code, names: set[str]) -> Iterator[Function]:
    for call in code.calls(*names):
        if (function := code.function_around(call)) is not None:
            yield function


def make_synchronous(code: Code, name: str) -> str | None:
    """Step: turn a coroutine that nothing runs into an ordinary function."""
    change = Changes(code)
    for function in code.functions_named(name):
        line = code.text.splitlines()[function.lineno - 1].strip()
        change.more.append(edits.replace_lines(function.lineno, line.removeprefix("async ")))
        for each in ast.walk(function):
            if isinstance(each, ast.Await):
                awaited = ast.unparse(each.value)
                future = awaited if awaited.isidentifier() else "future"
                assignment = [] if future == awaited else [f"future = {awaited}"]
                wait = f"{_spin_function(code)}({code.node_name(each)}, {future})"
                change.more.append(edits.insert_above(code.statement(each).lineno, "\n".join([*assignment, wait])))
                change.swaps.append((each, f"{future}.result()"))
    return change.as_step()
