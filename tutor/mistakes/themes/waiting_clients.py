"""Clients that wait for what never comes, or go on when all has come."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Sequence

from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import Frame, own_frame
from tutor.mistakes.entry import Case, Evidence, Found, found, found_at, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.clients import in_silence, requests
from tutor.source import called_name, last_name, values_of

_CALLS = (Symptom.CALLS_MISSING,)
_WAITING = (Symptom.CALLS_MISSING, Symptom.RUNS_ON, Symptom.NO_ANSWER)
_SPINS = ("spin", "spin_once", "spin_some", "spin_until_future_complete", "spin_once_until_future_complete")


def _stuck_at_last_line(*inner: Frame) -> Callable[[str], Sequence[Frame]]:
    def dump(source: str) -> Sequence[Frame]:
        lines = source.splitlines()
        return (*inner, Frame("/ws/node.py", len(lines), "main", lines[-1].strip(), 1))

    return dump


@mistake(
    "no-spin-for-the-answer",
    explains=_CALLS,
    evidence=Evidence.PROCESS,
    says="{line} waits for an answer, but nothing spins the node, so none can arrive: {code}",
    do="Spin the node while you wait, best until the future is complete.",
)
def no_spin_for_answer(case: Case) -> Iterator[Found]:
    """A client waits for an answer, but nothing spins.

    Answers arrive through the executor, like everything that reaches a node. A loop that only checks whether the future
    is done, an await in asyncio's own loop, or a call() in the only thread, waits for an answer that nothing takes in.

    Bad:

        future = door.call_async(Trigger.Request())
        while not future.done():
            time.sleep(0.1)

    Good:

        future = door.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(node, future)

    See it: the server logs the call, but the client never goes on.

    Lesson: i1.3, the client.
    """
    for file in case.files if in_silence(case) else ():
        spins = any(last_name(node) in _SPINS for source in {file, case.file} for node in source.nodes)
        if not spins and requests(file):
            awaits = [node for node in file.nodes if isinstance(node, ast.Await)]
            awaited = [node for node in awaits if any(call in ast.walk(node) for call in requests(file))]
            waits = [*awaited, *file.calls("done"), *(call for call in requests(file) if called_name(call) == "call")]
            yield from (found(file, call) for call in waits)


@mistake(
    "event-loop-not-woken",
    explains=_WAITING,
    evidence=Evidence.PROCESS,
    says="{line} runs in the executor's thread, and so does not wake asyncio's event loop: {code}",
    do="Let the loop itself set it, through the loop's call_soon_threadsafe().",
)
def loop_not_woken(case: Case) -> Iterator[Found]:
    """A ROS callback sets an asyncio event.

    asyncio's objects belong to the thread of their event loop. If they are set from another thread, as from a callback
    that an executor runs, they do change, but the loop sleeps on until something else wakes it.

    Bad:

        rung = asyncio.Event()
        future.add_done_callback(lambda done: rung.set())

    Good:

        rung, loop = asyncio.Event(), asyncio.get_running_loop()
        future.add_done_callback(lambda done: loop.call_soon_threadsafe(rung.set))

    See it: each wait lasts until its time limit.
    """
    for file in case.files if in_silence(case) else ():
        for call in file.calls("add_done_callback"):
            match call.args:
                case [ast.Lambda(body=ast.Call(func=ast.Attribute(value=owner, attr=name)))] if name in (
                    "set", "set_result", "set_exception", "put_nowait"
                ):  # fmt: skip
                    if any(map(_is_of_asyncio, values_of(ast.unparse(owner), file.tree))):
                        yield found(file, call)


def _is_of_asyncio(value: ast.expr) -> bool:
    made = ast.unparse(value.func) if isinstance(value, ast.Call) else ""
    return made.endswith("create_future") or made in ("asyncio.Event", "asyncio.Future", "asyncio.Queue")


@mistake(
    "event-never-set",
    explains=_WAITING,
    evidence=Evidence.RUN,
    says="{line} waits for {event}, but nothing in the program sets it: {code}",
    do="Set {event} where the answer arrives, such as in the future's done callback.",
    example=in_run(Symptom.RUNS_ON, stuck_at=_stuck_at_last_line()),
)
def event_never_set(case: Case) -> Iterator[Found]:
    """A thread waits for an event that nothing sets.

    The wait() of a threading.Event returns when another thread calls its set(). An answer that arrives does not do that
    on its own.

    Bad:

        self.rung = threading.Event()
        self.door.call_async(Trigger.Request())
        self.rung.wait()

    Good:

        self.rung = threading.Event()
        self.door.call_async(Trigger.Request()).add_done_callback(lambda done: self.rung.set())
        self.rung.wait()

    See it: the program stays at wait().
    """
    at = own_frame(case.stuck, case.trace.folder)
    waits = re.search(r"([\w.]+)\.wait\(", at.code) if at is not None else None
    if at is None or waits is None:
        return
    event = waits[1].rpartition(".")[2]
    names = [node for node in case.program.nodes() if isinstance(node, ast.Attribute) and node.attr == "set"]
    made = [
        call for file in case.files for call in file.calls("Event") if last_name_of(file.assigned_to(call)) == event
    ]
    if made and not any(last_name(node.value) == event for node in names):
        yield found_at(at, event=waits[1])


def last_name_of(target: str) -> str:
    """The last part of an assignment's target, such as "done" of "self.done"."""
    return target.rpartition(".")[2]


@mistake(
    "spin-never-returns",
    explains=[Symptom.RUNS_ON],
    evidence=Evidence.RUN,
    says="{line} spins until Ctrl+C, although all the answers are there: {code}",
    do="Spin only until each future is complete, and let main() end after the last one.",
    example=in_run(Symptom.RUNS_ON, stuck_at=_stuck_at_last_line(Frame("/lib/rclpy/executors.py", 1, "spin", "", 1))),
)
def spin_never_returns(case: Case) -> Iterator[Found]:
    """A program that should end spins forever.

    spin() returns on Ctrl+C or after a shutdown, not when there is nothing left to do. A program that is to end spins
    only until a future is complete.

    Bad:

        future.add_done_callback(self.rung)
        rclpy.spin(node)

    Good:

        rclpy.spin_until_future_complete(node, future)

    See it: the prompt does not come back.

    Lesson: i1.3, the client.
    """
    at = own_frame(case.stuck, case.trace.folder)
    if at is not None and re.search(r"\bspin\(", at.code):
        yield found_at(at)


@mistake(
    "thread-never-ends",
    explains=[Symptom.RUNS_ON],
    evidence=Evidence.RUN,
    says="a thread goes on{where}, and a program ends only when all its threads have",
    do="First end what the thread does: a spin with shutdown(), a loop through its condition.",
    example=in_run(
        Symptom.RUNS_ON, stuck_at=_stuck_at_last_line(Frame("/lib/python3.12/threading.py", 1, "join", "", 1))
    ),
)
def thread_never_ends(case: Case) -> Iterator[Found]:
    """A thread keeps the program from ending.

    Python ends when its last thread has ended, daemon threads aside; join() waits for one of them. A thread that spins
    ends with the context, and one that loops when its condition says so.

    Bad:

        thread = Thread(target=rclpy.spin, args=(node,))
        thread.start()
        ring_the_bell(node)
        thread.join()

    Good:

        thread = Thread(target=rclpy.spin, args=(node,))
        thread.start()
        ring_the_bell(node)
        rclpy.shutdown()
        thread.join()

    See it: the last line is printed, but the prompt does not come back.
    """
    waits = [frame for frame in case.stuck if frame.path.endswith("/threading.py")]
    if any(frame.function in ("_shutdown", "join") for frame in waits):
        at = own_frame(case.stuck, case.trace.folder)
        where = f" (line {at.line} of {at.name}: {at.code})" if at is not None else ""
        yield found_at(at, where=where)


@mistake(
    "zero-is-false",
    explains=[Symptom.CALLS_MISSING, Symptom.RUNS_ON],
    evidence=Evidence.RUN,
    says="{line} takes the answer 0 for no answer, since 0 counts as false: {code}",
    do="Compare with None there.",
    slip=True,
    example=in_run(Symptom.RUNS_ON, last_response={"count": 0}),
)
def zero_is_false(case: Case) -> Iterator[Found]:
    """An answer of 0 is taken for no answer.

    In a condition, 0, 0.0, an empty text and None are all false. To ask whether there is a value at all, use `is None`.

    Bad:

        rings = future.result().count
        while not rings:
            ask_again()

    Good:

        rings = future.result().count
        while rings is None:
            ask_again()

    See it: it works until an answer is 0.
    """
    zero = [name for name, value in (case.about("last_response") or {}).items() if value == 0]
    for file in case.files if zero else ():
        kept = [node for node in file.nodes if isinstance(node, ast.Assign) and last_name(node.value) in zero]
        names = {ast.unparse(node.targets[0]) for node in kept}
        for node in file.nodes:
            if isinstance(node, ast.If | ast.While):
                test = node.test.operand if isinstance(node.test, ast.UnaryOp) else node.test
                is_field = isinstance(test, ast.Attribute) and test.attr in zero
                if (is_field or ast.unparse(test) in names) and not isinstance(test, ast.Constant):
                    yield found(file, node)


@mistake(
    "did-not-end",
    explains=[Symptom.RUNS_ON],
    evidence=Evidence.SYMPTOM,
    says="the program has made all its calls, but {where}",
    do="Let main() return soon after the last answer, and let nothing wait for what will never come.",
    example=in_run(Symptom.RUNS_ON),
)
def did_not_end(case: Case) -> Iterator[Found]:
    """A program goes on after its work is done.

    A program ends when main() returns and no other thread is left. A pause, a loop with one round too many, or a wait
    for one more answer keeps it going.

    Bad:

        while len(answers) <= len(doors):
            rclpy.spin_once(node)

    Good:

        while len(answers) < len(doors):
            rclpy.spin_once(node)

    See it: the prompt does not come back.
    """
    at = own_frame(case.stuck, case.trace.folder)
    where = f"is still busy at line {at.line} of {at.name}: {at.code}" if at is not None else "does not end by itself"
    yield found_at(at, where=where)
