"""Programs whose node is up, but whose callbacks nobody runs."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from tutor.judge import tracebacks
from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import Frame
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import NodeFile, calls_in

SPINS = ("spin", "spin_once", "spin_some", "spin_until_future_complete")
EXECUTORS = ("SingleThreadedExecutor", "MultiThreadedExecutor", "EventsExecutor")
SPINS_ONCE = ("spin_once", "spin_some")

_SILENT = (
    Symptom.NO_ANSWER,
    Symptom.NO_MESSAGES,
    Symptom.NOTHING_RECEIVED,
    Symptom.CALLS_MISSING,
    Symptom.SERVICE_MISSING,
    Symptom.STANDS_STILL,
    Symptom.NOT_LOGGED,
)
_SLOW = (Symptom.WRONG_RATE, Symptom.NO_MESSAGES, Symptom.CHANGE_IGNORED, Symptom.STANDS_STILL)


def is_spinning(stuck: Sequence[Frame]) -> bool:
    """Whether a stack dump shows an rclpy executor at work."""
    return any(frame.path.endswith("rclpy/executors.py") for frame in stuck)


def _stuck_in_main(source: str) -> Sequence[Frame]:
    lines = source.splitlines()
    number = len(lines)
    return (
        Frame("/ws/node.py", number, "main", lines[-1].strip(), 1),
        Frame("/ws/node.py", number, "<module>", "main()", 1),
    )


@mistake(
    "no-spin",
    explains=_SILENT,
    evidence=Evidence.RUN,
    says="{nodes} exists, but its callbacks are never run{where}",
    do="Spin the node once everything is set up, and let nothing else keep the program from getting there.",
    example=in_run(Symptom.NO_ANSWER, answers=False, stuck_at=_stuck_in_main),
)
def no_spin(case: Case) -> Iterator[Found]:
    """Nothing spins the node.

    A node's callbacks are called by an executor, and only while it spins: rclpy.spin(node) does that until Ctrl+C. A
    program that sleeps, or runs a loop of its own, has a node that can be seen but does nothing.

    Bad:

        def main():
            rclpy.init()
            node = Doorbell()
            while rclpy.ok():
                time.sleep(0.1)

    Good:

        def main():
            rclpy.init()
            node = Doorbell()
            rclpy.spin(node)

    See it: `ros2 node list` shows the node; `ros2 param list NODE` gets no answer.

    Lesson: i1.1, on what spin() does.
    """
    if case.answers or is_spinning(case.stuck) or case.trace.exit is not None or not case.trace.graph.nodes:
        return
    topics = {publisher.topic for publisher in case.trace.graph.publishers}
    makes_one = case.about("topic") in topics or case.program.mentions("create_publisher")
    if case.symptom is Symptom.NO_MESSAGES and not makes_one:
        return  # a spin would bring none either
    threads = tracebacks.frames_by_thread(case.stuck)
    mains = [thread for thread in threads if thread[-1].function == "<module>"]
    at = tracebacks.own_frame(mains[0] if mains else case.stuck, case.trace.folder)
    if at is not None and "spin" not in at.code:
        where = f": the program stays at line {at.line} of {at.name}, {at.code}"
        yield Found({"where": where}, at.name, at.line, at.code)
    elif case.stuck or not any(file.calls(*SPINS) for file in case.files):
        yield Found({"where": ""})


@mistake(
    "node-not-added-to-the-executor",
    explains=_SILENT,
    says="{line} runs the callbacks of the nodes that were added to {executor}, but none was: {code}",
    do="Add the node to the executor before it spins.",
)
def node_not_added(case: Case) -> Iterator[Found]:
    """An executor spins, but has no node.

    An executor serves the nodes that were added to it, and no others. A node that is merely made is in the graph, but
    none of its callbacks is ever called.

    Bad:

        executor = MultiThreadedExecutor()
        bell = Doorbell()
        executor.spin()

    Good:

        executor = MultiThreadedExecutor()
        bell = Doorbell()
        executor.add_node(bell)
        executor.spin()

    See it: `ros2 node list` shows the node; `ros2 param list NODE` gets no answer.
    """
    if case.program.calls("add_node") or (case.answers and case.symptom is Symptom.NO_ANSWER):
        return
    for file in case.files:
        executors = {file.assigned_to(call) for call in file.calls(*EXECUTORS)} - {""}
        for call in file.calls("spin"):
            if not call.args and isinstance(call.func, ast.Attribute):
                executor = ast.unparse(call.func.value)
                if executor in executors:
                    yield found(file, call, executor=executor)


@mistake(
    "spins-in-the-constructor",
    explains=_SILENT,
    says="{line} spins inside the constructor, until the program ends: what comes after it is never made",
    do="Spin the node in main(), after its constructor has returned.",
)
def spin_in_constructor(case: Case) -> Iterator[Found]:
    """A node spins before its constructor has made everything.

    rclpy.spin() does not return until Ctrl+C. In a constructor, it keeps everything below it from being made, and the
    program from ever getting its node.

    Bad:

        class Doorbell(Node):
            def __init__(self):
                super().__init__('doorbell')
                rclpy.spin(self)
                self.create_service(Trigger, 'ring', self.ring)

        node = Doorbell()

    Good:

        class Doorbell(Node):
            def __init__(self):
                super().__init__('doorbell')
                self.create_service(Trigger, 'ring', self.ring)

        rclpy.spin(Doorbell())

    See it: `ros2 node info NODE` lacks what should be there.
    """
    for file in case.files:
        classes = [node for node in file.nodes if isinstance(node, ast.ClassDef)]
        bases = {ast.unparse(base) for owner in classes for base in owner.bases}
        if not file.calls(*file.node_classes):
            continue
        for owner in classes:
            for method in owner.body if owner.name in file.node_classes else ():
                if isinstance(method, ast.FunctionDef) and method.name == "__init__":
                    body = method.body if owner.name in bases else method.body[:-1]
                    yield from (found(file, statement) for statement in body if _spins_itself(file, statement))


def _spins_itself(file: NodeFile, statement: ast.stmt) -> bool:
    """Whether a statement, or a function that it calls, spins `self`."""
    called = [
        function
        for call in calls_in(statement)
        if (function := file.function(call.func)) is not None and statement not in function.body
    ]
    spins = [call for part in (statement, *called) for call in calls_in(part, "spin")]
    return any("self" in map(ast.unparse, call.args) for call in spins)


@mistake(
    "spin-once-waits",
    name="spin_once waits",
    explains=(*_SLOW, Symptom.CALLS_MISSING),
    says="{line} waits until a callback runs, {why}: {code}",
    do="Give spin_once a timeout_sec, or let a timer do the loop's work.",
)
def untimed_spin_once(case: Case) -> Iterator[Found]:
    """A loop stands still in spin_once().

    Without timeout_sec, spin_once() waits until there is a callback to run. A loop that also does work of its own is
    held up until then; with several nodes, each waits for the others' callbacks.

    Bad:

        while rclpy.ok():
            node.horn.publish(Bool(data=True))
            rclpy.spin_once(node)

    Good:

        while rclpy.ok():
            node.horn.publish(Bool(data=True))
            rclpy.spin_once(node, timeout_sec=0.1)

    See it: messages come only when another program asks the node for something.
    """
    for file in case.files:
        for loop in file.nodes:
            calls = calls_in(loop, *SPINS_ONCE) if isinstance(loop, ast.While | ast.For) else []
            for call in calls:
                given = [*call.args, *(keyword.value for keyword in call.keywords)]
                if any(keyword.arg == "timeout_sec" for keyword in call.keywords) or not isinstance(
                    call.func, ast.Attribute
                ):
                    continue
                is_while = isinstance(loop, ast.While)
                if is_while and not (file.timers or file.calls("create_subscription")) and publishes(file, loop):
                    yield found(file, call, why="and without a timer there is none")
                elif isinstance(loop, ast.For) and call.args and ast.unparse(loop.target) in map(ast.unparse, given):
                    yield found(file, call, why="and until then none of the other nodes gets a turn")


@mistake(
    "nap-between-callbacks",
    explains=_SLOW,
    says="{line} makes the loop that spins the node sleep, and meanwhile no callback runs: {code}",
    do="Remove the sleep; spin_once already waits until there is something to do.",
)
def nap_between_spins(case: Case) -> Iterator[Found]:
    """The loop that spins the node sleeps.

    spin_once() runs one callback, or waits for one. A sleep next to it delays every callback, even those that are due.

    Bad:

        while rclpy.ok():
            rclpy.spin_once(node)
            time.sleep(0.2)

    Good:

        while rclpy.ok():
            rclpy.spin_once(node)

    See it: `ros2 topic hz TOPIC` stays below five messages a second.
    """
    for file in case.files:
        for loop in file.nodes:
            if isinstance(loop, ast.While) and calls_in(loop, *SPINS_ONCE):
                yield from (found(file, nap) for nap in calls_in(loop, "sleep"))


def publishes(file: NodeFile, loop: ast.AST) -> bool:
    """Whether a loop publishes, itself or in a function that it calls."""
    functions = [function for call in calls_in(loop) if (function := file.function(call.func)) is not None]
    reached = [inner for function in functions for inner in file.reachable_from(function)]
    return bool(calls_in(loop, "publish")) or any(
        file.function_around(call) in reached for call in file.calls("publish")
    )
