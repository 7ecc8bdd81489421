"""I1.3: the verdict on the client, as a pure function of the facts."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence

from checks.i1_3 import client_names, steps
from checks.i1_3.client_fixes import missing_services, uses_none, with_client_step
from checks.i1_3.code import learner_files
from checks.i1_3.facts import CLIENT, CLIENT_S, OPERATOR_SIGNS, SERVER, SERVER_DELAY_S, ClientRun
from tutor.judge import causes, edits, source, tracebacks
from tutor.judge.causes import period_slips
from tutor.judge.causes.asyncio_threads import diagnose_other_threads_wake_up
from tutor.judge.causes.spinning import diagnose_untimed_spins_in_turn
from tutor.judge.causes.unawaited import unawaited_names
from tutor.judge.rewriting.node import NodeFile, find_in_files
from tutor.judge.rewriting.program import call_main, first_sound_step
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause, Verdict, failed, passed

WAITS = ("wait_for_service", "service_is_ready", "server_is_ready", "get_service_names_and_types", "wait_for_services")
"""Functions by which a client checks whether a service is available."""


def judge_client(seen: ClientRun) -> Verdict:
    """Judge `client`."""
    expected = (
        f"{CLIENT}, run without arguments, waits for the four services, which come up a little later, calls each of "
        f"them and ends by itself with 0 within {CLIENT_S:g} s"
    )
    if seen.trace is None:
        return failed(
            expected,
            f"there is no {CLIENT}",
            Cause("file missing", f"the submission has no {CLIENT}", f"write {CLIENT} beside {SERVER}"),
        )
    called = {served.service for served in seen.served}
    missing = missing_services(seen)
    calls_made = [f"{s.service} {s.request['a']} {s.request['b']} -> {s.response['sum']}" for s in seen.served[:12]]
    evidence = (*calls_made, *causes.output_tail(seen.trace, 4))
    if seen.exit is None:
        waits_in_vain = seen.watched_s < CLIENT_S
        state = (
            f"after {seen.watched_s:.1f} s it waits for nothing that could still come"
            if waits_in_vain
            else f"still running after {CLIENT_S:g} s"
        )
        observed = f"{state}; called {_list_services(called)}"
        return failed(expected, observed, with_client_step(_diagnose_hang(seen, missing), seen), evidence)
    ended = f"ended after {seen.exit.after_s:.1f} s with {seen.exit}"
    if seen.exit.code != 0:
        cause = with_client_step(_diagnose_exit_code(seen, missing, ended), seen)
        return failed(expected, f"{ended}; called {_list_services(called)}", cause, evidence)
    if missing:
        cause = with_client_step(_diagnose_not_called(seen, missing), seen)
        return failed(expected, f"{ended}; {', '.join(missing)} not called", cause, evidence)
    return passed(expected, f"{len(seen.served)} calls, {ended}", calls_made)


def _diagnose_exit_code(seen: ClientRun, missing: Sequence[str], ended: str) -> Cause:
    assert seen.trace is not None
    if (unknown := client_names.diagnose_client(seen, missing)) is not None and _follows_from_silence(seen.trace):
        return unknown
    if (not_met := _diagnose_missing_calls(seen, missing)) is not None and _follows_from_silence(seen.trace):
        return not_met
    asleep = find_in_files(seen.trace, diagnose_other_threads_wake_up)
    if asleep is not None and _follows_from_silence(seen.trace):
        return asleep
    cause = causes.diagnose_process(seen.trace)
    if cause is None or cause.name == "exit at once":
        return Cause("non-zero exit", f"the client {ended}", "end with return or sys.exit(0) when all went well")
    return cause


def _follows_from_silence(trace: Trace) -> bool:
    """Whether the program ended for want of an answer: deliberately, or because it used None as one."""
    found = tracebacks.last_traceback(trace)
    if found is None:
        return True
    own = found.own(trace.folder)
    deliberate = own is not None and own.code.startswith(("raise ", "assert "))
    return deliberate or found.type.endswith("TimeoutError") or uses_none(found)


def _diagnose_not_called(seen: ClientRun, missing: Sequence[str]) -> Cause:
    assert seen.trace is not None
    if seen.trace.uncalled_main and not seen.served:
        return Cause(
            "no main call",
            "main() is defined, but nothing calls it",
            first_sound_step(seen.trace, call_main) or 'end the file with: if __name__ == "__main__": main()',
        )
    return (
        causes.diagnose_incompatible_service(seen.clients)
        or client_names.diagnose_client(seen, missing)
        or _diagnose_unawaited(seen.trace)
        or _diagnose_early_return(seen)
        or _diagnose_missing_calls(seen, missing)
        or Cause(
            "not called",
            f"{', '.join(missing)} got no request",
            "call each service, and wait for each answer before you go on",
        )
    )


def _diagnose_hang(seen: ClientRun, missing: Sequence[str]) -> Cause:
    assert seen.trace is not None
    if (mismatched := causes.diagnose_incompatible_service(seen.clients)) is not None:
        return mismatched
    if (unknown := client_names.diagnose_client(seen, missing)) is not None:
        return unknown
    if (asleep := find_in_files(seen.trace, diagnose_other_threads_wake_up)) is not None:
        return asleep
    zero = bool(seen.served) and seen.served[-1].response["sum"] == 0
    if zero and (falsy := find_in_files(seen.trace, _diagnose_falsy_zero)) is not None:
        return falsy
    if (in_turn := find_in_files(seen.trace, diagnose_untimed_spins_in_turn)) is not None:
        return in_turn
    if not seen.served and (unit := find_in_files(seen.trace, period_slips.diagnose_milliseconds)) is not None:
        return unit
    own = tracebacks.own_frame(seen.stuck, seen.trace.folder)
    where = f" at {own}" if own else ""
    spins = any(frame.function.startswith("spin") for frame in seen.stuck)
    if causes.is_in_blocking_call(seen.stuck) and not spins:
        return Cause(
            "deadlock by call()",
            f"the client waits forever{where}: call() blocks the thread that would have to receive the answer",
            "use call_async() and rclpy.spin_until_future_complete(node, future), outside of callbacks",
        )
    if (not_met := _diagnose_missing_calls(seen, missing)) is not None:
        return not_met
    if own is not None and not missing and re.search(r"\bspin\(", own.code):
        return Cause(
            "did not end",
            f"the client was still busy{where}: spin() runs until someone presses Ctrl+C",
            _replace_spin(seen.trace, own),
        )
    return Cause(
        "did not end",
        f"the client was still busy{where}" if where else "the client does not end by itself",
        "wait for each service, use call_async(), spin until its future is done, and return after the last answer",
    )


def _diagnose_falsy_zero(file: NodeFile) -> Cause | None:
    """Whether the client takes a result of 0 for no result: it goes on, or ends, only if the result is true."""
    kept = [each for each in file.nodes if isinstance(each, ast.Assign) and source.last_name(each.value) == "sum"]
    results = {ast.unparse(each.targets[0]) for each in kept}
    for each in file.nodes:
        if not isinstance(each, ast.If | ast.While):
            continue
        match each.test:
            case ast.UnaryOp(op=ast.Not(), operand=result):
                comparison = "is"
            case result:
                comparison = "is not"
        if (isinstance(result, ast.Attribute) and result.attr == "sum") or ast.unparse(result) in results:
            right = f"{ast.unparse(result)} {comparison} None"
            step = file.step([edits.replace_node(file.text, each.test, right)])
            text = f"line {each.lineno} takes the result 0 for none: the number 0 counts as false"
            return Cause("zero is false", text, step) if step else None
    return None


def _replace_spin(trace: Trace, own: tracebacks.Frame) -> str:
    """Step that replaces a spin() that never returns: wait for each answer if it is spin() that receives them."""
    code = next((each for each in learner_files(trace) if each.file == own.name), None)
    if code is None:
        return "end the program when the last answer has come"
    if not source.calls(trace, "add_done_callback", "create_timer"):
        return code.as_step(edits.remove_lines(code.text, own.line)) or ""
    requests = [made for made in source.assigned(trace, "call_async") if made[0].isidentifier()]
    spins = re.fullmatch(r"(?P<rclpy>\w+)\.spin\((?P<node>\w+)\)", own.code)
    if not requests or spins is None or source.calls(trace, "create_timer"):
        return "end the program in the callback that gets the last answer: raise SystemExit"
    future, line = requests[0]
    lines = (
        f"for {future} in {spins['node']}.futures:",
        f"    {spins['rclpy']}.spin_until_future_complete({spins['node']}, {future})",
        f"{spins['rclpy']}.spin_once({spins['node']}, timeout_sec=0.5)",
    )
    kept = edits.insert_below(line, f"self.futures = [*getattr(self, 'futures', []), {future}]")
    return code.as_step(kept, edits.replace_lines(own.line, "\n".join(lines))) or ""


def _diagnose_unawaited(trace: Trace) -> Cause | None:
    """Diagnose a coroutine that was created but never run, from Python's own warning."""
    if not (unawaited := unawaited_names(trace)):
        return None
    name = unawaited[0]
    return Cause(
        "coroutine not awaited",
        f"{name} is an async def: calling it only makes a coroutine, and nothing in it runs",
        f"write def {name} in place of async def {name}, and in it, in place of await future: "
        "rclpy.spin_until_future_complete(self, future), then future.result()",
    )


def _diagnose_early_return(seen: ClientRun) -> Cause | None:
    """Diagnose a client that made only the first call because a return ends the loop over its calls."""
    assert seen.trace is not None
    if len(seen.served) != 1:
        return None
    for code in learner_files(seen.trace):
        if (found := steps.move_return(code)) is not None:
            loop, returns, step = found
            return Cause(
                "return in the loop",
                f"line {returns.lineno}: {ast.unparse(returns)} ends the loop of line {loop.lineno} in its first "
                f"iteration, after {seen.served[0].service}",
                step,
            )
    return None


def _diagnose_missing_calls(seen: ClientRun, missing: Sequence[str]) -> Cause | None:
    """Diagnose missing calls to services that the client never found: no wait for them, or too short a one."""
    assert seen.trace is not None
    if not missing or not source.calls(seen.trace, "call_async", "call"):
        return None
    if not source.mentions(seen.trace, *WAITS):
        return Cause(
            "service not waited for",
            f"the request was sent before there was a server, and such a request is lost: {missing[0]} came up "
            f"{SERVER_DELAY_S:g} s after the client",
            "before the first request, call wait_for_service(timeout_sec=10.0) of each service client",
        )
    if gave_up_early(seen):
        assert seen.exit is not None
        return Cause(
            "waits too short a time",
            f"it gave up after {seen.exit.after_s:.1f} s, before it had found our servers: they come up about a second "
            "after it",
            "wait long enough for the service: wait_for_service(timeout_sec=10.0)",
        )
    return None


def gave_up_early(seen: ClientRun) -> bool:
    """Whether the client waits for our servers, but exited by itself before it had found one."""
    if seen.trace is None or seen.exit is None or seen.served or not source.mentions(seen.trace, *WAITS):
        return False
    return bool(seen.clients) or not source.mentions(seen.trace, "argv", "ArgumentParser")


def _list_services(called: set[str]) -> str:
    return ", ".join(name for name in OPERATOR_SIGNS if name in called) or "nothing"
