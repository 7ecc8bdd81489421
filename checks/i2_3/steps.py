"""I2.3: the next step in the words of the learner's own file: its lines, its groups, its executor.

The source only chooses the words; None where it says nothing.
"""

from __future__ import annotations

import re

from checks.i2_3.facts import WORK_S
from checks.i2_3.ticks import HZ
from tutor.judge.reading import Call, Function, Source
from tutor.judge.verdict import Cause

_GROUP = "callback_group"
_THREADS = 8


def service(source: Source) -> Call | None:
    """Where the service is made."""
    return next(iter(source.calls("create_service")), None)


def timer(source: Source) -> Call | None:
    """Where the timer is made."""
    return next(iter(source.calls("create_timer")), None)


def _works(source: Source) -> Function | None:
    """The service's callback."""
    made = service(source)
    return _named(source, made.argument(2, "callback")) if made else None


def _ticks(source: Source) -> Function | None:
    """The timer's callback."""
    made = timer(source)
    return _named(source, made.argument(1, "callback")) if made else None


def _named(source: Source, given: str) -> Function | None:
    return next(iter(source.functions(given.rpartition(".")[2])[-1:]), None)


def executor(source: Source) -> str | None:
    """The step where one thread runs all callbacks."""
    spun = next((call for call in source.calls("spin") if call.given), None)
    own = next((call for call in source.calls("spin") if not call.given), None)
    many = next(iter(source.calls("MultiThreadedExecutor")), None)
    single = next(iter(source.calls("SingleThreadedExecutor")), None)
    steps: list[str] = []
    if spun is not None and spun.within == "__init__":
        steps = [f"remove line {spun.line}, {spun.code}: it never ends, so the executor is not reached"]
    elif spun is not None and many is not None and own is not None:
        steps = [f"remove line {spun.line}, {spun.code}: it never ends, so that line {own.line} is not reached"]
    elif spun is not None and many is not None and many.kept:
        steps = [f"line {spun.line}: {many.kept}.spin() instead of {spun.code}"]
        if not source.calls("add_node"):
            steps = [f"right before line {spun.line}: {many.kept}.add_node({spun.given[0]})", *steps]
    elif spun is not None:
        steps = [
            f"instead of line {spun.line}, {spun.code}:",
            f"executor = MultiThreadedExecutor(num_threads={_THREADS})",
            f"executor.add_node({spun.given[0]})",
            "executor.spin()",
        ]
    elif single is not None:
        steps = [single.becomes(f"MultiThreadedExecutor(num_threads={_THREADS})")]
    if not steps:
        return None
    if not source.imports("MultiThreadedExecutor") and many is None:
        steps.append("at the top of the file: from rclpy.executors import MultiThreadedExecutor")
    return "\n".join([*steps, *filter(None, [groups(source)])])


def threads(source: Source) -> str | None:
    """The step where an executor has one thread only."""
    made = next(iter(source.calls("MultiThreadedExecutor")), None)
    if made is None or made.argument(0, "num_threads") != "1":
        return None
    return made.becomes(f"MultiThreadedExecutor(num_threads={_THREADS})")


def held_by(source: Source) -> str:
    """What the timer waits for while the service works, though the executor has threads."""
    ticking = timer(source)
    if (step := threads(source)) is not None:
        return f"the executor has too few threads, 1 ({step.partition(':')[0]})"
    if ticking is None or groups(source) is None:
        return (
            "they are in one MutuallyExclusiveCallbackGroup (a node's default group is one), or the executor has too "
            "few threads"
        )
    group = _same(source, ticking.named.get(_GROUP, ""))
    if not group:
        return "both are in the node's default group, which is a MutuallyExclusiveCallbackGroup"
    return f"both are in {group}, which is a MutuallyExclusiveCallbackGroup"


def groups(source: Source) -> str | None:
    """The step where the timer and the service are in one group."""
    ticking, working = timer(source), service(source)
    if ticking is None or working is None:
        return None
    mine, other = ticking.named.get(_GROUP, ""), working.named.get(_GROUP, "")
    if _same(source, mine) != _same(source, other):
        return None
    spare = next(
        (
            each.target
            for each in source.assignments()
            if each.value.endswith("CallbackGroup()")
            and each.target.startswith("self.")
            and each.target != other
            and each.line < ticking.line
        ),
        "ReentrantCallbackGroup()",
    )
    code = _with_group(ticking, spare)
    imported = "" if spare.startswith("self.") or source.imports("ReentrantCallbackGroup") else _IMPORT
    return f"{ticking.becomes(code)}{imported}"


_IMPORT = "\nat the top of the file: from rclpy.callback_groups import ReentrantCallbackGroup"


def _same(source: Source, group: str) -> str:
    """What a group is called that may be the node's default one."""
    return "" if group in ("", "None", "self.default_callback_group") else group


def _with_group(call: Call, group: str) -> str:
    if _GROUP in call.named:
        return call.code.replace(f"{_GROUP}={call.named[_GROUP]}", f"{_GROUP}={group}")
    return f"{call.code[:-1]}, {_GROUP}={group})"


def apart(source: Source) -> str | None:
    """The step where calls wait for each other: the service's group, or too few threads."""
    working = service(source)
    if working is None:
        return None
    if (callback := _works(source)) is not None and (held := re.search(r"with (self\.\w+):", callback.code)):
        return f"leave `{held[0]}` out of {callback.name} (line {callback.line}): it lets in one call at a time"
    group, steps = working.named.get(_GROUP, ""), []
    made = next((each for each in source.assignments(group) if "CallbackGroup" in each.value), None) if group else None
    imported = "" if source.imports("ReentrantCallbackGroup") else _IMPORT
    if made is not None and "Reentrant" not in made.value:
        steps.append(f"line {made.line}: {made.target} = ReentrantCallbackGroup(){imported}")
    elif made is None and "Reentrant" not in group:
        steps.append(working.becomes(_with_group(working, "ReentrantCallbackGroup()")) + imported)
    many = next(iter(source.calls("MultiThreadedExecutor")), None)
    if many is not None and many.argument(0, "num_threads") in ("1", "2", "3", ""):
        steps.append(many.becomes(f"MultiThreadedExecutor(num_threads={_THREADS})"))
    return "\n".join(steps) or executor(source)


def not_added(source: Source) -> Cause | None:
    """Whether an executor is spun that has no node."""
    made = next(iter(source.calls("MultiThreadedExecutor", "SingleThreadedExecutor")), None)
    spun = next((call for call in source.calls("spin") if not call.given), None)
    if made is None or spun is None or source.calls("add_node"):
        return None
    node = next((call.kept for name in source.bases() for call in source.calls(name) if call.kept), "node")
    return Cause(
        "node not added to the executor",
        f"line {spun.line}: {spun.code} runs the callbacks of the nodes that were added to it, and none was",
        f"right before line {spun.line}: {made.kept or 'executor'}.add_node({node})",
    )


def work(source: Source) -> str | None:
    """The step where the work takes another time than it should."""
    working = _works(source)
    if working is None:
        return None
    sleeps = [call for call in source.calls("sleep") if call.within == working.name and call.given]
    if len(sleeps) == 1 and "for " not in working.code and "while " not in working.code:
        return sleeps[0].instead(sleeps[0].given[0], str(WORK_S))
    if sleeps or source.calls("wait"):
        return None
    imported = "" if source.imports("time") else "\nat the top of the file: import time"
    return f"begin {working.name} (line {working.line}) with: time.sleep({WORK_S}){imported}"


def too_early(source: Source) -> Cause | None:
    """Whether the callback answers while another thread is still at work."""
    working = _works(source)
    if working is None:
        return None
    started = next(
        (call for call in source.calls("Thread", "Timer", "submit", "create_task") if call.within == working.name), None
    )
    if started is None:
        return None
    request, response = (*working.arguments, "request", "response")[:2]
    return Cause(
        "answered too early",
        f"{started.where} does the work beside {working.name}, which answers at once; the response that is filled in "
        "later reaches nobody",
        f"let {working.name} (line {working.line}) do it all, and start nothing:\n"
        f"time.sleep({WORK_S})\n"
        f"{response}.sum = {request}.a + {request}.b\n"
        f"return {response}",
    )


def shared(source: Source) -> str | None:
    """The step where a callback keeps in self what belongs to one call."""
    working = _works(source)
    if working is None:
        return None
    kept = [each for each in source.assignments() if each.within == working.name and each.target.startswith("self.")]
    names = list(dict.fromkeys(each.target for each in kept))
    if not names:
        return None
    return "; ".join(
        f"in {working.name} (line {working.line}), write {name.removeprefix('self.')} instead of {name}"
        for name in names
    )


def period(source: Source) -> str | None:
    """The step where the timer has another period than it should, or its callback takes too long."""
    made, ticking = timer(source), _ticks(source)
    if made is None or not made.given:
        return None
    right = f"{1 / HZ:g}"
    sleeps = [call for call in source.calls("sleep") if ticking is not None and call.within == ticking.name]
    if sleeps:
        return f"remove line {sleeps[0].line}, {sleeps[0].code}: a timer's callback must not wait"
    texts = [made.given[0], *(each.value for each in source.assignments(made.given[0]))]
    if any(text in (right, "1 / 10", "1.0 / 10.0", "1.0 / 10", "100 / 1000") for text in texts):
        return None
    return made.instead(made.given[0], right)


def silent(source: Source) -> Cause | None:
    """Why no message of the timer's comes."""
    made, ticking = timer(source), _ticks(source)
    if made is None or ticking is None:
        return None
    logs = [call for call in source.calls("info", "warning", "warn", "error", "fatal") if call.within == ticking.name]
    quiet = next((call for call in source.calls("debug") if call.within == ticking.name), None)
    if quiet is not None and not logs:
        return Cause(
            "no timer messages",
            f"{quiet.where}: debug messages are not shown",
            quiet.instead(".debug(", ".info("),
        )
    if not logs:
        return Cause(
            "no timer messages",
            f"{ticking.name} (line {ticking.line}) logs nothing",
            f"end {ticking.name} with: self.get_logger().info(f'Tick {{{_counter(source, ticking)}}}')",
        )
    if (found := re.fullmatch(r"[\d.]+", made.given[0] if made.given else "")) and float(found[0]) > 2 / HZ:
        return Cause(
            "wrong timer period",
            f"{made.where} ticks once in {found[0]} s: create_timer takes the seconds between two ticks, not ticks per "
            "second",
            str(period(source)),
        )
    return None


def numbered(source: Source) -> str | None:
    """The step where the messages bear no number of the tick."""
    ticking = _ticks(source)
    if ticking is None:
        return None
    logs = [call for call in source.calls("info", "warning", "warn", "error") if call.within == ticking.name]
    counter = _counter(source, ticking)
    if not logs or not counter.startswith("self."):
        return None
    return f"line {logs[0].line}: self.get_logger().info(f'Tick {{{counter}}}')"


def _counter(source: Source, ticking: Function) -> str:
    """What counts the ticks."""
    for each in source.assignments():
        if each.within == ticking.name and each.value.startswith(f"{each.target} + "):
            return each.target
    return "self.ticks"


def waiting(code: str, line: int) -> str | None:
    """The step where a callback waits for something that never comes, in this line."""
    if not re.search(r"\.(?:wait|acquire|get|join|result)\(\)", code):
        return None
    return f"line {line}: time.sleep({WORK_S}) instead of {code}"


def lock(source: Source) -> str | None:
    """The step where the timer's callback waits for a lock that the service's holds."""
    ticking, working = _ticks(source), _works(source)
    if ticking is None or working is None:
        return None
    held = re.search(r"with (self\.\w+):", ticking.code)
    if held is None or held[0] not in working.code:
        return None
    return f"leave `{held[0]}` out of {ticking.name} (line {ticking.line}): it must not wait for {working.name}"
