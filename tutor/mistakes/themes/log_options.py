"""Options of a log call that keep messages back: throttles, once and skip_first."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import Level, LogRecord
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import NodeFile, called_name, values_of

_METHODS = ("debug", "info", "warning", "warn", "error", "fatal", "log")
_OPTIONS = {
    "throttle_duration_sec": "at most one message in that many seconds",
    "once": "only the first message",
    "skip_first": "every message but the first",
}


def _logged_before(function: str) -> tuple[LogRecord, ...]:
    """An earlier event of the same kind that this function has logged, for an example."""
    return (LogRecord(Level.INFO, "node", "open", 0.0, 0.0, function),)


def _log_calls(file: NodeFile) -> Iterator[ast.Call]:
    for node in file.nodes:
        if isinstance(node, ast.Call) and called_name(node) in _METHODS and isinstance(node.func, ast.Attribute):
            yield node


def _options(call: ast.Call) -> list[str]:
    """The options that a log call is given, but for those that are switched off."""
    on = (each.arg for each in call.keywords if not (isinstance(each.value, ast.Constant) and not each.value.value))
    return [name for name in on if name in _OPTIONS]


def _logged_earlier_by(case: Case, option: str) -> Iterator[tuple[NodeFile, ast.Call]]:
    """Calls with this option in the functions that have logged an earlier event of the kind, or this one."""
    logs = (*case.about("earlier", ()), *(getattr(case.about("event"), "logs", ()) if case.about("too_few") else ()))
    for file in case.files:
        for call in _log_calls(file):
            if option in _options(call) and any(_may_have_made(file, call, log) for log in logs):
                yield file, call


def _seconds(file: NodeFile, call: ast.Call, option: str) -> float | None:
    """The value of an option that is a number, or the name of one in the file; None if it is not known."""
    value = next((keyword.value for keyword in call.keywords if keyword.arg == option), None)
    if isinstance(value, ast.Name | ast.Attribute):
        value = next(iter(values_of(ast.unparse(value), file.tree)), None)
    number = value.value if isinstance(value, ast.Constant) else None
    return float(number) if isinstance(number, int | float) else None


def _is_over(case: Case, throttle_s: float | None) -> bool:
    """Whether a throttle that an earlier event began would have let a message of this one through."""
    sent, earlier = getattr(case.about("event"), "sent", ()), case.about("earlier", ())
    if throttle_s is None or not sent or not earlier:
        return False
    return bool(sent[-1] >= max(log.stamp for log in earlier) + throttle_s)


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
    "log-call-keeps-messages-back",
    explains=[Symptom.NOT_LOGGED, Symptom.WRONG_LOG],
    says="{line} logs {what}, since it has {option}: {code}",
    do="Leave out that option where every message counts.",
)
def kept_back(case: Case) -> Iterator[Found]:
    """An option of a log call drops messages.

    throttle_duration_sec, once and skip_first are meant for a line that would flood the log. What they drop is gone: it
    is not logged later.

    Bad:

        self.get_logger().info(f'visitor {self.visitors}', throttle_duration_sec=60.0)

    Good:

        self.get_logger().info(f'visitor {self.visitors}')

    See it: count the lines of `ros2 topic echo /rosout`.
    """
    for file in case.files if "rate" not in case.about("fault", "") else ():
        for node in file.nodes:
            if isinstance(node, ast.Call) and called_name(node) in _METHODS:
                for option in _options(node):
                    yield found(file, node, option=option, what=_OPTIONS[option])


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
            if _is_over(case, _seconds(file, call, "throttle_duration_sec")):
                continue
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
            function, options = file.function_around(call), _options(call)
            if function is None or not options or not call.args or not _logs_at(call, case.about("wanted")):
                continue
            arguments = {argument.arg for argument in (*function.args.args, *function.args.kwonlyargs)}
            if _root(call.func) in arguments - {"self"}:
                continue  # each caller has a logger of its own, and so a throttle of its own
            used = {node.id for node in ast.walk(call.args[0]) if isinstance(node, ast.Name)}
            callers = file.calls(function.name)
            if used & (arguments - {"self"}) and len(callers) > 1:
                yield found(file, call, option=options[0], count=len(callers))


def _logs_at(call: ast.Call, wanted: Level | None) -> bool:
    """Whether a log call may log at this level, which None leaves open."""
    name = (called_name(call) or "").upper().replace("WARNING", "WARN")
    return wanted is None or name == "LOG" or name == wanted.name


def _root(node: ast.expr) -> str:
    """The variable with which an expression such as `loggers["low"].warning` begins."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


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
            options, function = _options(call), file.function_around(call)
            logger = call.func.value if isinstance(call.func, ast.Attribute) else None
            if not options or function is None or function.name == "__init__":
                continue
            if isinstance(logger, ast.Name):
                logger = next(iter(values_of(logger.id, function)), None)
            if isinstance(logger, ast.Call) and _is_new(logger):
                yield found(file, call, option=options[0])


def _is_new(made: ast.Call) -> bool:
    """Whether a call makes a logger that is not the node's own."""
    return called_name(made) == "get_child" or (called_name(made) == "get_logger" and bool(made.args))
