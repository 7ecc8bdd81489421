"""Nodes that end by themselves: in a callback, or since nothing keeps them running."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.ending import SPIN_ENDINGS
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Exit
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.ended_processes import EXITS, WHILE_A_NODE_RUNS, ended_by_itself, how_it_ended
from tutor.mistakes.themes.spinning import SPINS, SPINS_ONCE
from tutor.source import NodeFile, argument, called_name, last_name

_SHUTDOWNS = ("shutdown", "try_shutdown")


@mistake(
    "ended-by-a-callback",
    explains=WHILE_A_NODE_RUNS,
    evidence=Evidence.PROCESS,
    says="{ended}: {line}, in {function}, ends the program: {code}",
    do="Let the callback return, and let the program run until Ctrl+C.",
    example=in_run(Symptom.ENDED, exit=Exit(0, None, 1.2)),
)
def exit_in_callback(case: Case) -> Iterator[Found]:
    """A callback ends the program.

    A callback that calls sys.exit() or rclpy.shutdown() ends the node at the first message or tick.

    Bad:

        def __init__(self):
            self.create_timer(1.0, self.ring)

        def ring(self):
            sys.exit()

    Good:

        def __init__(self):
            self.create_timer(1.0, self.ring)

        def ring(self):
            self.get_logger().info('ding')

    See it: the node is gone after its first callback.
    """
    if (ended := ended_by_itself(case)) is None:
        return
    for file in case.files:
        for call in file.calls("create_timer"):
            given = argument(call, "callback")
            if given is not None and last_name(given) in (*EXITS, *_SHUTDOWNS):
                yield found(file, call, ended=how_it_ended(ended), function="a timer")
        for function in file.callbacks("create_timer", "create_subscription", "create_service"):
            for node in ast.walk(function):
                match node:
                    case ast.Raise(exc=ast.expr() as raised) if "SystemExit" in ast.unparse(raised):
                        yield found(file, node, ended=how_it_ended(ended), function=function.name)
                    case ast.Expr(value=ast.Call() as call) if called_name(call) in (*EXITS, *_SHUTDOWNS):
                        yield found(file, node, ended=how_it_ended(ended), function=function.name)


@mistake(
    "exception-caught-outside-spin",
    explains=WHILE_A_NODE_RUNS,
    evidence=Evidence.PROCESS,
    says="{ended}: an exception leaves a callback, and with it the spin; {line} catches it outside, which is too late: "
    "{code}",
    do="Handle it in the callback, so that the callback returns and the node goes on.",
    example=in_run(Symptom.NO_ANSWER, exit=Exit(1, None, 4.2), logs=["ding"]),
)
def caught_outside_spin(case: Case) -> Iterator[Found]:
    """An exception is caught around the spin, when the node has already stopped.

    rclpy does not catch what a callback raises: the exception comes out of rclpy.spin(), and no other callback is
    called any more. An except clause there keeps the traceback from being shown, but not the node from ending.

    Bad:

        def ring(self, request, response):
            raise ValueError('the bell is broken')

        def main():
            rclpy.init()
            try:
                rclpy.spin(Doorbell())
            except ValueError as error:
                print(error)

    Good:

        def ring(self, request, response):
            try:
                self.bell.ring()
            except ValueError as error:
                self.get_logger().error(str(error))
            return response

        def main():
            rclpy.init()
            rclpy.spin(Doorbell())

    See it: the node is gone from `ros2 node list` after the first call.
    """
    if (ended := ended_by_itself(case)) is None or ended.code is None:
        return
    for file in case.files:
        for call in file.calls("spin"):
            for around in file.ancestors(call):
                for handler in around.handlers if isinstance(around, ast.Try) else ():
                    if not _is_for_the_end(handler):
                        yield found(file, handler, ended=how_it_ended(ended))


def _is_for_the_end(handler: ast.ExceptHandler) -> bool:
    """Whether a handler catches only what ends a spin in any case, such as Ctrl+C."""
    caught = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return all(last_name(exception) in (*SPIN_ENDINGS, "SystemExit") for exception in caught)


@mistake(
    "exit-at-once",
    explains=WHILE_A_NODE_RUNS,
    evidence=Evidence.PROCESS,
    says="{ended}: {what}",
    do="Spin the node until Ctrl+C, once everything is set up.",
    example=in_run(Symptom.ENDED, exit=Exit(0, None, 0.4)),
)
def exit_at_once(case: Case) -> Iterator[Found]:
    """The program runs to its end.

    A node lives as long as its program. rclpy.spin(node) keeps it running until Ctrl+C; spin_once() handles one
    callback and returns; without either, main() is done in a moment.

    Bad:

        def main():
            rclpy.init()
            node = Doorbell()
            rclpy.spin_once(node)

    Good:

        def main():
            rclpy.init()
            node = Doorbell()
            rclpy.spin(node)

    See it: `ros2 node list` a second after the start.
    """
    if (ended := ended_by_itself(case)) is None or ended.code is None:
        return
    yield from _without_spin(case, how_it_ended(ended))
    yield Found({"ended": how_it_ended(ended), "what": "nothing keeps it running"})


def _without_spin(case: Case, ended: str) -> Iterator[Found]:
    """Where the source shows that the program spins only once, or not at all."""
    if case.trace.exit is None or case.trace.exit.code != 0 or case.program.calls("spin"):
        return
    for file in case.files:
        loops = [node for node in file.nodes if isinstance(node, ast.While | ast.For)]
        once = [call for call in file.calls(*SPINS_ONCE) if not any(call in ast.walk(loop) for loop in loops)]
        for call in once:
            what = f"line {call.lineno} handles at most one callback, and then the program is done"
            yield found(file, call, ended=ended, what=what)
    if not case.program.calls(*SPINS):
        for file in case.files:
            for call in file.calls(*file.node_classes, "Node", "create_node"):
                if _is_made_by_program(file, call):
                    what = f"it makes a node in line {call.lineno}, but never spins it"
                    yield found(file, call, ended=ended, what=what)


def _is_made_by_program(file: NodeFile, call: ast.Call) -> bool:
    return file.class_of(call) is None
