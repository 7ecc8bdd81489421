"""Callbacks that never return, as a stack dump shows: where each is stuck, and what it waits for."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Sequence

from tutor.judge import tracebacks
from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import Frame
from tutor.mistakes.entry import Case, Evidence, Found, found, found_at, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.callback_groups import in_worker
from tutor.source import NodeFile, calls_in

_SILENT = (
    Symptom.NO_ANSWER,
    Symptom.NO_MESSAGES,
    Symptom.NOTHING_RECEIVED,
    Symptom.WRONG_ANSWER,
    Symptom.CALLS_MISSING,
    Symptom.WRONG_RATE,
)
_LOCK = re.compile(
    r"(?P<lock>[\w.]+)\.acquire\(|with (?P<with>[\w.]*(?:lock|mutex|semaphore|condition)\w*)", re.IGNORECASE
)


def _stuck_in(*inner: tuple[str, str]) -> Callable[[str], Sequence[Frame]]:
    """A stack dump of a callback that is stuck in the last line of an example."""

    def dump(source: str) -> Sequence[Frame]:
        lines = source.splitlines()
        own = Frame("/ws/node.py", len(lines), "on_bell", lines[-1].strip(), 1)
        called = [Frame(path, 1, function, "", 1) for path, function in inner]
        return (*called, own, Frame("/lib/rclpy/executors.py", 1, "spin", "", 1))

    return dump


def in_blocking_call(frames: Sequence[Frame]) -> bool:
    """Whether a thread is waiting in rclpy's blocking `Client.call()`."""
    return any(frame.function == "call" and frame.path.endswith("rclpy/client.py") for frame in frames)


def _blocked(case: Case) -> tuple[Frame, tuple[Frame, ...]] | None:
    """The learner's innermost frame in a running callback, and the frames that it has called.

    A callback that waits for another one takes precedence over one that is busy.
    """
    folder, blocked = case.trace.folder, []
    for thread in tracebacks.frames_by_thread(case.stuck):
        if tracebacks.called_by_executor(thread, folder):
            own = next(i for i, frame in enumerate(thread) if tracebacks.is_in_folder(frame.path, folder))
            blocked.append((thread[own], thread[:own]))
    return min(
        blocked, key=lambda frames: not (in_blocking_call(frames[1]) or _LOCK.search(frames[0].code)), default=None
    )


@mistake(
    "deadlock-by-call",
    name="deadlock by call()",
    explains=_SILENT,
    evidence=Evidence.RUN,
    says="{line} waits for a service's answer, which cannot arrive meanwhile{why}: {code}",
    do="Await call_async() in an async callback, and put it and the client into groups that may run together.",
    example=in_run(Symptom.NO_ANSWER, stuck_at=_stuck_in(("/lib/rclpy/client.py", "call"))),
)
def deadlock_by_call(case: Case) -> Iterator[Found]:
    """A callback calls a service with call(), and waits forever.

    call() blocks until the answer is there. The answer is taken in by the executor, which is busy running this
    callback; with one thread, or in the same callback group, neither can go on.

    Bad:

        def on_bell(self, request, response):
            self.door.call(Trigger.Request())

    Good:

        async def on_bell(self, request, response):
            await self.door.call_async(Trigger.Request())
            return response

    See it: `ros2 service call` never returns, though `ros2 node list` shows the node.

    Lesson: i2.3, on callback groups.
    """
    blocked = _blocked(case)
    if blocked is not None and in_blocking_call(blocked[1]):
        yield found_at(blocked[0], why=f", since this callback keeps {_kept_busy(case)} busy")
    elif blocked is None and in_blocking_call(case.stuck):
        yield found_at(tracebacks.own_frame(case.stuck, case.trace.folder), why="")


@mistake(
    "spin-inside-a-callback",
    explains=_SILENT,
    evidence=Evidence.RUN,
    says="{line} spins the node inside its own callback, and waits for what cannot happen until that returns: {code}",
    do="Take the spin out of the callback; await the future there, or continue in its done callback.",
    remark="this spins inside a callback: calls that come meanwhile nest in it, and it cannot end before they do.",
    example=in_run(Symptom.NO_ANSWER, stuck_at=_stuck_in(("/lib/rclpy/__init__.py", "spin"))),
)
def spin_inside_callback(case: Case) -> Iterator[Found]:
    """A callback spins the node that runs it.

    The executor calls the callback; a second spin inside it takes the node away from that executor, or waits for a
    callback of the group that this one keeps. Where it gets on at all, calls nest, and the first one ends last.

    Bad:

        def __init__(self):
            self.create_service(Trigger, 'ring', self.on_bell)

        def on_bell(self, request, response):
            rclpy.spin_until_future_complete(self, self.answer)

    Good:

        def __init__(self):
            self.create_service(Trigger, 'ring', self.on_bell)

        async def on_bell(self, request, response):
            await self.answer
            return response

    See it: the first call never returns, and then none does.
    """
    blocked = _blocked(case)
    if blocked is not None:
        if any(frame.path.endswith(("rclpy/executors.py", "rclpy/__init__.py")) for frame in blocked[1]):
            yield found_at(blocked[0])
    elif case.answers:
        for file in case.files:
            callbacks = file.callbacks("create_timer", "create_subscription", "create_service")
            for call in file.calls("spin", "spin_once", "spin_until_future_complete"):
                if call.args and ast.unparse(call.args[0]) == "self" and file.function_around(call) in callbacks:
                    yield found(file, call)


@mistake(
    "waits-for-a-lock",
    explains=(*_SILENT, Symptom.STANDS_STILL),
    evidence=Evidence.RUN,
    says="{line} waits for {lock}, {why}: {code}",
    do="Hold a lock only while shared data changes, never while you wait, and release it on every way out.",
    example=in_run(Symptom.NO_ANSWER, stuck_at=_stuck_in(("/lib/threading.py", "acquire"))),
)
def waits_for_a_lock(case: Case) -> Iterator[Found]:
    """A callback waits for a lock that nobody releases.

    A lock lets one thread in at a time. A thread that holds it while it sleeps makes all others wait that long; one
    that takes a plain Lock twice waits for itself, forever.

    Bad:

        def on_bell(self, request, response):
            self.lock.acquire()

    Good:

        def on_bell(self, request, response):
            with self.lock:
                self.rings += 1
            return response

    See it: the log stands still while one callback works.
    """
    blocked = _blocked(case)
    if blocked is None or not (matched := _LOCK.search(blocked[0].code)):
        return
    folder = case.trace.folder
    holders = [
        frame
        for thread in tracebacks.frames_by_thread(case.stuck)
        if (frame := tracebacks.own_frame(thread, folder)) is not None
        and tracebacks.called_by_executor(thread, folder)
        and not _LOCK.search(frame.code)
    ]
    why = f"which another callback holds at line {holders[0].line}" if holders else "and nothing will release it"
    yield found_at(blocked[0], lock=matched["lock"] or matched["with"], why=why)


@mistake(
    "polls-a-future",
    explains=_SILENT,
    evidence=Evidence.RUN,
    says="{line} waits for {future}, which cannot be done while this callback keeps {busy} busy: {code}",
    do="Await {future} in an async callback with the client in a group of its own, or continue in its done callback.",
    example=in_run(Symptom.NO_ANSWER, stuck_at=_stuck_in()),
)
def polls_a_future(case: Case) -> Iterator[Found]:
    """A callback waits in a loop until a future is done.

    The answer that completes the future arrives through the executor, and the executor is running this callback. The
    loop waits for something that waits for the loop.

    Bad:

        def on_bell(self, request, response):
            while not self.answer.done(): pass

    Good:

        async def on_bell(self, request, response):
            await self.answer
            return response

    See it: one core is busy, and nothing happens.
    """
    blocked = _blocked(case)
    for file in case.files:
        callbacks = file.callbacks("create_timer", "create_subscription", "create_service")
        for call in file.calls("done"):
            future = ast.unparse(call.func).removesuffix(".done")
            loop = next((node for node in file.ancestors(call) if isinstance(node, ast.While | ast.For)), None)
            if loop is None or not (isinstance(loop, ast.While) or calls_in(loop, "sleep")):
                continue
            words = {"future": future, "busy": _kept_busy(case)}
            if blocked is None and case.answers and file.function_around(loop) in callbacks and not _has_groups(file):
                yield found(file, loop, **words)
            elif blocked is not None and blocked[0].name == file.name and _spans(loop, blocked[0].line):
                yield found_at(blocked[0], **words)


def _spans(loop: ast.While | ast.For, line: int) -> bool:
    return loop.lineno <= line <= (loop.end_lineno or 0)


def _kept_busy(case: Case) -> str:
    """What a callback that waits keeps others from: the only thread, or its group among several threads."""
    return "its callback group" if in_worker(case.stuck) else "the executor"


def _has_groups(file: NodeFile) -> bool:
    return any(keyword.arg == "callback_group" for call in file.calls("create_client") for keyword in call.keywords)


@mistake(
    "blocked-executor",
    explains=_SILENT,
    evidence=Evidence.RUN,
    says="{line} keeps a callback from returning{why}: {code}",
    do="{step}",
    example=in_run(Symptom.NO_ANSWER, stuck_at=_stuck_in()),
)
def blocked_executor(case: Case) -> Iterator[Found]:
    """A callback never returns.

    An executor runs one callback after another (a MultiThreadedExecutor, as many at once as it has threads). A loop or
    a wait in one of them keeps all others waiting, even those that answer requests for parameters.

    Bad:

        def on_bell(self, message):
            while self.ringing:
                time.sleep(0.5)

    Good:

        def on_bell(self, message):
            self.timer.reset()

    See it: `ros2 param list NODE` does not return.
    """
    blocked = _blocked(case)
    if blocked is not None:
        at, inner = blocked
        waits = any(frame.path.endswith("/threading.py") for frame in inner) or ".wait(" in at.code
        step = "Let the callback return at once, and leave to a timer whatever has to wait, or happen again."
        if case.about("service") is not None:
            step = "Let the callback get past this line in every case, and return its response."
        yield found_at(at, why=", for nothing has ended this wait" if waits else "", step=step)
