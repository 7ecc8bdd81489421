"""What keeps a log call from saying each event once, at its level: options, helpers, new loggers, set levels."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from math import isnan, nan
from types import SimpleNamespace
from typing import Any

from tutor.judge.symptom import Symptom
from tutor.judge.trace import Level, LogRecord
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import NodeFile, called_name, calls_in, values_of

_METHODS = ("debug", "info", "warning", "warn", "error", "fatal", "log")
_OPTIONS = ("throttle_duration_sec", "once", "skip_first")
_MAKES_LOGGER = ("get_child", "get_logger")


def _logged_before(function: str) -> tuple[LogRecord, ...]:
    """An earlier event of the same kind that this function has logged, for an example."""
    return (LogRecord(Level.INFO, "node", "open", 0.0, 0.0, function),)


def _log_calls(file: NodeFile) -> Iterator[ast.Call]:
    for node in file.nodes:
        if isinstance(node, ast.Call) and called_name(node) in _METHODS and isinstance(node.func, ast.Attribute):
            yield node


def _option(call: ast.Call, *names: str) -> str:
    """The first of these options that a log call is given, if it is not switched off."""
    for keyword in call.keywords:
        off = isinstance(keyword.value, ast.Constant) and not keyword.value.value
        if keyword.arg in names and not off:
            return str(keyword.arg)
    return ""


def _logged_earlier_by(case: Case, *options: str) -> Iterator[tuple[NodeFile, ast.Call]]:
    """Calls with one of these options in the functions that have logged an earlier event of the kind, or this one."""
    logs = (*case.about("earlier", ()), *(getattr(case.about("event"), "logs", ()) if case.about("too_few") else ()))
    for file in case.files:
        for call in _log_calls(file):
            if _option(call, *options) and any(_may_have_made(file, call, log) for log in logs):
                yield file, call


def _may_have_made(file: NodeFile, call: ast.Call, log: LogRecord) -> bool:
    """Whether a log call is in the function that has logged a message, whose text has the call's fixed parts."""
    function = file.function_around(call)
    if function is None or function.name != log.function or not call.args:
        return False
    message = call.args[0]
    parts = message.values if isinstance(message, ast.JoinedStr) else [message]
    texts = [part.value for part in parts if isinstance(part, ast.Constant)]
    return all(text in log.text for text in texts if isinstance(text, str))


@mistake(
    "once-is-for-the-whole-run",
    explains=[Symptom.WRONG_LEVEL],
    evidence=Evidence.RUN,
    says="{what} is logged the first time, and then never again in this run, since {line} has once=True: {code}",
    do="Take once for what is true of the whole run; what happens again must be logged again.",
    example=in_run(Symptom.WRONG_LEVEL, what="a door that opens", earlier=_logged_before("on_door")),
)
def once_for_the_run(case: Case) -> Iterator[Found]:
    """A message with once=True is logged once in the whole run, not once in each event.

    rclpy notes for each line whether it has logged, and never forgets it: there is nothing that would tell it that one
    event is over and another one begins. For something that can happen again, remember in the node how it was before.

    Bad:

        def on_door(self, door):
            if door.data:
                self.get_logger().info('open', once=True)

    Good:

        def on_door(self, door):
            if door.data and not self.open:
                self.get_logger().info('open')
            self.open = door.data

    See it: let it happen twice, and look at `ros2 topic echo /rosout`.

    Lesson: b1.6, on how often.
    """
    for file, call in _logged_earlier_by(case, "once"):
        yield found(file, call, what=case.about("what", "it"))


@mistake(
    "throttled-though-each-one-counts",
    explains=[Symptom.WRONG_LEVEL],
    evidence=Evidence.RUN,
    says="{line} drops what comes within {option} of the message before, and with it {what}: {code}",
    do="Leave out the throttle where each event counts, and log the event only when it begins.",
    example=in_run(Symptom.WRONG_LEVEL, what="a door that opens", earlier=_logged_before("on_door")),
)
def throttled_events(case: Case) -> Iterator[Found]:
    """A throttle drops events that differ from each other.

    A throttle is for a state that lasts and that would be logged again and again: one message stands for all those that
    it drops. But each single event says something else, and those within that time are lost for good.

    Bad:

        def on_door(self, door):
            if door.data and not self.open:
                self.get_logger().info('open', throttle_duration_sec=5.0)
            self.open = door.data

    Good:

        def on_door(self, door):
            if door.data and not self.open:
                self.get_logger().info('open')
            self.open = door.data

    See it: let two events come soon after each other, and look at `ros2 topic echo /rosout`.

    Lesson: b1.6, on how often.
    """
    if not case.about("too_few"):
        for file, call in _logged_earlier_by(case, "throttle_duration_sec"):
            yield found(file, call, what=case.about("what", "it"), option="throttle_duration_sec")


@mistake(
    "throttle-shared-by-a-helper",
    explains=[Symptom.WRONG_LEVEL],
    says="{line} logs for {count} callers, and {option} counts by line, so that one keeps back the others: {code}",
    do="Give each kind of message a log call of its own, or keep the time of the last one for each kind yourself.",
)
def shared_throttle(case: Case) -> Iterator[Found]:
    """A helper logs messages of several kinds with one throttle.

    rclpy keeps the time of the last message, and whether there was one, for each place in the code that calls the
    logger. In a helper, this is one place for all who call it: the first message silences the others, whatever they
    say.

    Bad:

        def warn(self, text):
            self.get_logger().warning(text, throttle_duration_sec=10.0)

        def on_door(self, door):
            if door.blocked:
                self.warn('blocked')
            if door.loud:
                self.warn('loud')

    Good:

        def on_door(self, door):
            if door.blocked:
                self.get_logger().warning('blocked', throttle_duration_sec=10.0)
            if door.loud:
                self.get_logger().warning('loud', throttle_duration_sec=10.0)

    See it: let both happen at once; only one of them is in the log.

    Lesson: b1.6, on which line.
    """
    for file in case.files:
        for call in _log_calls(file):
            function, option = file.function_around(call), _option(call, *_OPTIONS)
            if function is None or not option or not call.args:
                continue
            arguments = {argument.arg for argument in (*function.args.args, *function.args.kwonlyargs)}
            used = {node.id for node in ast.walk(call.args[0]) if isinstance(node, ast.Name)}
            callers = file.calls(function.name)
            if used & (arguments - {"self"}) and len(callers) > 1:
                yield found(file, call, option=option, count=len(callers))


@mistake(
    "throttle-without-memory",
    explains=[Symptom.LOGGED_TOO_OFTEN],
    says="{line} asks a new logger each time, which has logged nothing yet: {option} lets everything through: {code}",
    do="Make the logger once, when the node is made, and keep it.",
)
def without_memory(case: Case) -> Iterator[Found]:
    """A new logger for each message, with a throttle that remembers nothing.

    What was logged, and when, is kept in the logger object. get_child() and rclpy.logging.get_logger() make a new one
    each time they are called, and it has logged nothing yet. Only a node's own get_logger() returns the same one again.

    Bad:

        def on_door(self, door):
            self.get_logger().get_child('door').warning('blocked', throttle_duration_sec=10.0)

    Good:

        def __init__(self):
            super().__init__('lift')
            self.door_logger = self.get_logger().get_child('door')

        def on_door(self, door):
            self.door_logger.warning('blocked', throttle_duration_sec=10.0)

    See it: count the lines of `ros2 topic echo /rosout`.

    Lesson: b1.6, a logger without memory.
    """
    for file in case.files:
        for call in _log_calls(file):
            option, function = _option(call, *_OPTIONS), file.function_around(call)
            logger = call.func.value if isinstance(call.func, ast.Attribute) else None
            if not option or function is None or function.name == "__init__":
                continue
            if isinstance(logger, ast.Name):
                logger = next(iter(values_of(logger.id, function)), None)
            if isinstance(logger, ast.Call) and _is_new(logger):
                yield found(file, call, option=option)


def _is_new(made: ast.Call) -> bool:
    """Whether a call makes a logger that is not the node's own."""
    return called_name(made) == "get_child" or (called_name(made) == "get_logger" and bool(made.args))


@mistake(
    "level-set-in-the-code",
    explains=[Symptom.LOGGED_TOO_OFTEN, Symptom.WRONG_LEVEL],
    says="{line} sets the level itself, whatever --log-level says: {code}",
    do="Leave the level to whoever starts the node.",
)
def level_set(case: Case) -> Iterator[Found]:
    """A node sets the level of its logger in its code.

    Which messages are made is up to whoever runs a node: INFO by default, `--log-level debug` to look for a fault. A
    level that is set in the code wins over the command line, and nobody can switch it without changing the program.

    Bad:

        self.get_logger().set_level(LoggingSeverity.DEBUG)

    Good:

        self.get_logger().debug('door at 43 %')

    See it: `ros2 run PACKAGE NODE --ros-args --log-level LEVEL` makes no difference.

    Lesson: b1.6, on levels.
    """
    logged = case.about("logged", ())
    lost = case.symptom is Symptom.WRONG_LEVEL and case.about("wanted") is Level.DEBUG
    if lost or all(log.level == Level.DEBUG for log in logged):
        for file in case.files:
            for call in file.calls("set_level", "set_logger_level"):
                yield found(file, call)


def _with_nan(*values: float) -> Any:
    """An event with these values, for an example."""
    return SimpleNamespace(event=SimpleNamespace(messages=tuple({"data": value} for value in values)), logs=())


@mistake(
    "nan-passes-every-comparison",
    name="NaN passes every comparison",
    explains=[Symptom.WRONG_LEVEL],
    evidence=Evidence.RUN,
    says="the reading is NaN, which is neither below nor above anything: each comparison with it is false",
    do="Ask whether the value is inside its range, and take everything else for broken.",
    example=in_run(Symptom.WRONG_LEVEL, event=_with_nan(nan)),
)
def nan_passes(case: Case) -> Iterator[Found]:
    """NaN is not found by looking for what is out of range.

    A sensor says NaN, not a number, when it does not know. Every comparison with NaN is false: it is not below the
    lowest value, and not above the highest one. Ask whether a value is inside the range, which NaN is not either.

    Bad:

        if weight < 0.0 or weight > 500.0:
            self.get_logger().error('no weight')

    Good:

        if not 0.0 <= weight <= 500.0:
            self.get_logger().error('no weight')

    See it: `python3 -c "print(float('nan') > 500.0)"`.

    Lesson: b1.6, not a number.
    """
    event = getattr(case.about("event"), "event", None)
    values = [value for message in getattr(event, "messages", ()) for value in message.values()]
    if not any(isinstance(value, float) and isnan(value) for value in values):
        return
    for file in case.files:
        for node in file.nodes:
            if _is_out_of_range(node) and not _knows_nan(file.function_around(node) or file.tree):
                yield found(file, node)
    compares = any(_is_order(node) for file in case.files for node in file.nodes)
    if compares and not any(_knows_nan(file.tree) for file in case.files):
        yield Found()


def _knows_nan(code: ast.AST) -> bool:
    """Whether a part of the code asks for NaN, or for what is within a range, which NaN is not."""
    return bool(calls_in(code, "isnan", "isfinite")) or any(_is_range(node) for node in ast.walk(code))


def _is_out_of_range(node: ast.AST) -> bool:
    """Whether this is a condition such as `x < 0 or x > 1`."""
    return (
        isinstance(node, ast.BoolOp)
        and isinstance(node.op, ast.Or)
        and sum(isinstance(value, ast.Compare) for value in node.values) > 1
    )


def _is_order(node: ast.AST) -> bool:
    """Whether this is a comparison such as `x > 1`."""
    return isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.Lt | ast.LtE | ast.Gt | ast.GtE)


def _is_range(node: ast.AST) -> bool:
    """Whether this is a comparison such as `0 <= x <= 1`."""
    return isinstance(node, ast.Compare) and len(node.ops) > 1
