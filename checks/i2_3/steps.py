"""I2.3: next steps that refer to the learner's own file: its lines, its callback groups, its executor.

Each step is tried on a copy of the file, the shortest edit first; the last resort rewrites everything that may be
relevant. The source only determines the wording. A step is None if no edit is possible.
"""

from __future__ import annotations

import ast

from checks.i2_3 import rewriting
from checks.i2_3.callback_groups import (
    group_edits,
    group_of,
    is_reentrant,
    replace_looked_up_group,
    set_group,
    timers_in_its_group,
)
from checks.i2_3.facts import SERVICE, WORK_S
from checks.i2_3.rewriting import combine_edits, service, service_callback, timer
from tutor.judge.causes.topics import use_default_service_qos
from tutor.judge.edits import Edit, remove_statement, replace_lines, replace_node, replace_statement
from tutor.judge.rewriting.node import NodeFile, argument
from tutor.judge.rewriting.program import whole_program
from tutor.judge.source import called_name, calls_in, last_name
from tutor.judge.verdict import Cause

_MULTI_THREADED = "MultiThreadedExecutor"
_THREADS = 8


def rewrite_everything(file: NodeFile) -> str | None:
    """The step that rewrites service, timer and main program, where no shorter one is known to help."""
    parts = (
        rewriting.rewrite_service(file),
        rewriting.rewrite_timer(file),
        rewriting.rewrite_service_callback(file),
        rewriting.rewrite_timer_callback(file),
    )
    proposals = (
        combine_edits(file, *parts, rewriting.rewrite_program(file)),
        combine_edits(file, *parts),
        rewriting.rewrite_program(file),
    )
    return file.step(*(each for each in proposals if not all(map(_is_import, each))))


def _is_import(edit: Edit) -> bool:
    return edit.code.startswith(("from ", "import "))


def use_default_qos(file: NodeFile) -> str | None:
    """The step that leaves the service's QoS at its default."""
    return file.step(use_default_service_qos(file))


def fix_service(file: NodeFile) -> str | None:
    """The step where the service is missing, or has the wrong name or type."""
    made = service(file)
    name = argument(made, 1, "srv_name") if made is not None else None
    right = ast.unparse(name).strip("'\"") == SERVICE[1:] if name is not None else False
    renamed = [replace_node(file.text, name, repr(SERVICE if right else SERVICE[1:]))] if name is not None else []
    kind = argument(made, 0, "srv_type") if made is not None else None
    same = kind is not None and ast.unparse(kind).endswith("AddTwoInts")
    return file.step(
        renamed if same else None,
        combine_edits(file, rewriting.rewrite_service(file), rewriting.rewrite_service_callback(file)),
    ) or rewrite_everything(file)


def fix_answer(file: NodeFile) -> str | None:
    """The step where the answer is wrong or missing."""
    return file.step(rewriting.rewrite_service_callback(file)) or rewrite_everything(file)


def fix_work_time(file: NodeFile) -> str | None:
    """The step where the work takes the wrong time."""
    return file.step(_fix_sleep(file)) or fix_answer(file)


def _fix_sleep(file: NodeFile) -> list[Edit]:
    found = service_callback(file)
    if found is None or any(isinstance(each, ast.While | ast.For | ast.If) for each in ast.walk(found)):
        return []
    naps = calls_in(found, "sleep", "wait")
    if len(naps) != 1 or len(naps[0].args) != 1:
        return []
    if called_name(naps[0]) == "wait" and _seconds(file, naps[0].args[0]) == WORK_S:  # it may return at once
        sleep, imported = rewriting.sleep_expression(file)
        return [*imported, replace_node(file.text, naps[0], f"{sleep}({WORK_S})")]
    return [replace_node(file.text, naps[0].args[0], str(WORK_S))]


def _seconds(file: NodeFile, expression: ast.expr) -> float | None:
    """The value of a number, or of a variable or attribute that is assigned only one."""
    name = last_name(expression)
    assigned = [each for each in file.nodes if isinstance(each, ast.Assign) and name in map(last_name, each.targets)]
    values = [each.value for each in assigned]
    return rewriting.number(values[0] if len(values) == 1 else expression)


def use_threads(file: NodeFile) -> str | None:
    """The step where one thread runs all callbacks."""
    return file.step(_with_group_edits(file, _fix_executor(file))) or rewrite_everything(file)


def _fix_executor(file: NodeFile) -> list[Edit]:
    spins = file.calls("spin")
    spun = next((each for each in spins if each.args), None)
    multi, single = (
        next(iter(file.calls(_MULTI_THREADED)), None),
        next(iter(file.calls("SingleThreadedExecutor")), None),
    )
    kept = file.assigned_to(multi) if multi is not None else ""
    own = next(
        (each for each in spins if not each.args and (not kept or ast.unparse(each.func) == f"{kept}.spin")), None
    )
    name, imported = file.import_name(_MULTI_THREADED, "rclpy.executors")
    if spun is not None and multi is not None and own is not None:
        if file.function_around(own) is not file.function_around(spun):  # in a thread, which main() has to wait for
            event, imported = file.import_name("Event", "threading")
            return [*imported, replace_statement(spun, f"{event}().wait()")]
        return [remove_statement(file.text, file.statement(spun))]
    if spun is not None and multi is not None and kept and len(spun.args) == 1:
        node = ast.unparse(spun.args[0])
        added = "" if file.calls("add_node") else f"{kept}.add_node({node})\n"
        few = argument(multi, 0, "num_threads")
        enough = [replace_node(file.text, few, str(_THREADS))] if few is not None and ast.unparse(few) == "1" else []
        return [replace_statement(spun, f"{added}{kept}.spin()"), *_remove_spinning_threads(file, kept), *enough]
    if spun is None and multi is None and single is not None:
        return [*imported, replace_node(file.text, single, f"{name}(num_threads={_THREADS})")]
    return rewriting.rewrite_program(file)


def _remove_spinning_threads(file: NodeFile, executor: str) -> list[Edit]:
    """Remove the threads that spin this executor, with the statements that start and join them."""
    removed: list[Edit] = []
    for made in file.calls("Thread"):
        target = next((ast.unparse(each.value) for each in made.keywords if each.arg == "target"), "")
        if target == f"{executor}.spin":
            thread = file.assigned_to(made)
            uses = [each for each in file.calls("start", "join") if thread == ast.unparse(each.func).rpartition(".")[0]]
            removed += [remove_statement(file.text, file.statement(each)) for each in (made, *uses)]
    return removed


def _with_group_edits(file: NodeFile, edits: list[Edit]) -> list[Edit]:
    return combine_edits(file, edits, group_edits(file)) if edits else []


def separate_groups(file: NodeFile) -> str | None:
    """The step where the timer waits for the service although several threads run the callbacks."""
    return (
        file.step(
            _add_threads(file),
            group_edits(file),
            replace_looked_up_group(file),
            rewriting.rewrite_service_callback(file),
        )
        or file.step(
            combine_edits(file, rewriting.rewrite_service_callback(file), rewriting.rewrite_timer_callback(file))
        )
        or rewrite_everything(file)
    )


def _add_threads(file: NodeFile) -> list[Edit]:
    """More threads for a MultiThreadedExecutor that has only one, or another number if nothing else is wrong."""
    made = next(iter(file.calls(_MULTI_THREADED)), None)
    given = argument(made, 0, "num_threads") if made is not None else None
    if given is None or ast.unparse(given) == str(_THREADS) or (ast.unparse(given) != "1" and group_edits(file)):
        return []
    return [] if _has_enough_threads(file) else [replace_node(file.text, given, str(_THREADS))]


def _has_enough_threads(file: NodeFile) -> bool:
    """Whether the executor has threads for the timer and a call, and one to spare."""
    made = next(iter(file.calls(_MULTI_THREADED)), None)
    given = argument(made, 0, "num_threads") if made is not None else None
    return given is not None and (rewriting.number(given) or 0) >= 3


def what_timer_waits_for(file: NodeFile, *, sleeps: bool = False) -> str:
    """Why the timer waits for the service although the executor has threads, as part of a sentence.

    `sleeps`: whether the service sleeps meanwhile, which lets other threads run.
    """
    made, shared = timer(file), timers_in_its_group(file)
    if edits := _add_threads(file):
        return f"the executor has too few threads (line {edits[0].first})"
    if made is not None and not sleeps and not shared and _has_enough_threads(file):
        return "Python runs one thread at a time, and this work lets no other one run, unlike time.sleep()"
    if made is None or not shared:
        return (
            "they are in one MutuallyExclusiveCallbackGroup (a node's default group is one), or the executor has too "
            "few threads"
        )
    group = group_of(shared[0])
    who = "both" if made in shared else f"the service and the timer of line {shared[0].lineno}"
    if any(each.arg is None for each in shared[0].keywords):  # the group is in a dict of options
        return f"{who} are in the same MutuallyExclusiveCallbackGroup"
    if not group:
        return f"{who} are in the node's default group, which is a MutuallyExclusiveCallbackGroup"
    return f"{who} are in {group}, which is a MutuallyExclusiveCallbackGroup"


def allow_overlap(file: NodeFile) -> str | None:
    """The step where calls wait for each other: due to the service's callback group, or too few threads."""
    made = service(file)
    name, imported = file.import_name("ReentrantCallbackGroup", "rclpy.callback_groups")
    edits: list[Edit] = []
    if made is not None and not is_reentrant(file, group_of(made)):
        edits += [*imported, set_group(file, made, f"{name}()")]
    multi = next(iter(file.calls(_MULTI_THREADED)), None)
    given = argument(multi, 0, "num_threads") if multi is not None else None
    if multi is not None and (given is None or ast.unparse(given) in ("1", "2", "3")):
        edits.append(replace_node(file.text, multi, f"{ast.unparse(multi.func)}(num_threads={_THREADS})"))
    return file.step(edits) or fix_answer(file)


def diagnose_node_not_added(file: NodeFile) -> Cause | None:
    """Find an executor that is spun without a node."""
    made = next(iter(file.calls(_MULTI_THREADED, "SingleThreadedExecutor")), None)
    spun = next((each for each in file.calls("spin") if not each.args), None)
    if made is None or spun is None or file.calls("add_node"):
        return None
    if (step := file.step(whole_program(file))) is None:
        return None
    return Cause(
        "node not added to the executor",
        f"line {spun.lineno}: {ast.unparse(spun)} runs the callbacks of the nodes that were added to it, and none was",
        step,
    )


def diagnose_early_answer(file: NodeFile) -> Cause | None:
    """Find a callback that answers while another thread is still working."""
    found = service_callback(file)
    started = next(iter(calls_in(found, "Thread", "Timer", "submit", "create_task")), None)
    if found is None or started is None or (step := fix_answer(file)) is None:
        return None
    return Cause(
        "answered too early",
        f"line {started.lineno}: {ast.unparse(started)} does the work in parallel to {found.name}, which answers at "
        "once; the response that is filled in later reaches nobody",
        step,
    )


def remove_wait(file: NodeFile, code: str, line: int) -> str | None:
    """The step where a callback waits in this line for something that never happens."""
    limited = [replace_lines(line, code.replace(".wait()", f".wait({WORK_S})"))] if file.text else []
    return file.step(limited) or fix_answer(file)
