"""Logging: what is printed instead, what never reaches /rosout, and what a level leaves out."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Sequence
from typing import cast

from tutor.judge import tracebacks
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Level, OutputLine
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import SourceFile, calls_in
from tutor.source.print_calls import find_print, find_python_logging

_LOGS = (Symptom.NOT_LOGGED, Symptom.WRONG_LEVEL, Symptom.STANDS_STILL)
_SHOWN = ("info", "warning", "warn", "error", "fatal")
_LEVELS = {"WARN": Level.WARN, "WARNING": Level.WARN, "ERROR": Level.ERROR, "FATAL": Level.FATAL}
_LOG_LINE = re.compile(r"^(?:\x1b\[\d+m)?\[(?:DEBUG|INFO|WARN|ERROR|FATAL)\] \[\d+\.\d+\] \[(?P<logger>[^\]]*)\]")
"""Start of the line that rclpy writes to the terminal for a log message, in addition to sending it to /rosout."""

_NOT_THE_LEARNERS = re.compile(
    r"^Failed to publish log message to rosout|^>>> \[rcutils|^This error state is being overwritten"
    r"|^with this new error message|^rcutils_reset_error|^Exception ignored in|, at \S+\.(?:c|cpp|hpp):\d+$"
    r"|:\d+: \w*Warning: "
)
"""Messages of the ROS libraries themselves, mostly after the shutdown, and warnings of Python."""

_ROS_LOGGER = re.compile(r"^(?:rcl|rclcpp|rmw_\w+)(?:\.|$)")


def _recognise(case: Case) -> Callable[[str], object] | None:
    """What recognises the text that should have been logged: the function `recognise`, or the text `value`."""
    if (recognise := case.about("recognise")) is not None:
        return cast("Callable[[str], object]", recognise)
    value = case.about("value")
    return (lambda text: str(value) in text) if value is not None else None


def _printed(output: Sequence[OutputLine]) -> list[str]:
    """The lines that the learner's code printed, without log messages, exceptions, and what ROS or Python writes."""
    raised = {traceback.raised for traceback in tracebacks.find_tracebacks(output)}
    return [
        text
        for text in tracebacks.lines_without_tracebacks(output)
        if text not in raised and not _LOG_LINE.match(text) and not _NOT_THE_LEARNERS.search(text)
    ]


def _place(case: Case, call: tuple[SourceFile, ast.Call] | None, **words: object) -> Found:
    return found(*call, **words) if call is not None else Found(dict(words))


@mistake(
    "printed-not-logged",
    name="printed, not logged",
    explains=_LOGS,
    evidence=Evidence.RUN,
    says="{what} is written with {how}{where}, which no other program sees",
    do="Log it with the node's own logger, which sends it to /rosout as well.",
    example=in_run(Symptom.NOT_LOGGED, what="the owner", value="Ada", output=["owner: Ada"]),
)
def printed(case: Case) -> Iterator[Found]:
    """Something is printed instead of logged.

    print() and Python's own logging module write to the terminal of this one program. The logger of a node also sends
    each message to the topic /rosout, with the node's name, a level and a time, where tools and other nodes find it.

    Bad:

        print(f'owner: {self.owner}')

    Good:

        self.get_logger().info(f'owner: {self.owner}')

    See it: `ros2 topic echo /rosout`.

    Lesson: i1.1, on log messages.
    """
    is_it, what = _recognise(case), case.about("what", "it")
    if is_it is None:
        return
    for text in _printed(case.trace.output):
        if is_it(text):
            logging = find_python_logging(case.program, text)
            call = logging or find_print(case.program, text)
            where = f" (line {call[1].lineno})" if call is not None else ""
            yield _place(case, call, what=what, how="Python's logging" if logging else "print()", where=where)
            return
    logging = None if case.program.calls("get_logger") else find_python_logging(case.program)
    if logging is not None:
        yield _place(case, logging, what=what, how="Python's logging", where=f" (line {logging[1].lineno})")


@mistake(
    "output-held-back-by-buffering",
    explains=_LOGS,
    evidence=Evidence.RUN,
    says="{what} is printed, but appears only when the program ends: in a pipe, print() waits for a full buffer",
    do="Log it with the node's own logger: a log message goes out at once.",
    example=in_run(
        Symptom.NOT_LOGGED, what="the owner", value="Ada", at_end=(OutputLine("stdout", "owner: Ada", 1.0),)
    ),
)
def held_back(case: Case) -> Iterator[Found]:
    """Printed output is held back in a buffer.

    In a terminal, print() shows each line at once. For a pipe or a file, Python first collects some thousand
    characters; what is left comes out when the program ends, or never if it is killed.

    Bad:

        print(f'owner: {self.owner}')

    Good:

        self.get_logger().info(f'owner: {self.owner}')

    See it: `python3 node.py | cat`.
    """
    is_it = _recognise(case)
    if is_it is not None:
        for text in _printed(tuple(case.about("at_end", ()))):
            if is_it(text):
                yield _place(case, find_print(case.program, text), what=case.about("what", "it"))


def _logged_elsewhere(case: Case) -> list[re.Match[str]]:
    """The log lines on the terminal with the text that are not on /rosout."""
    is_it = _recognise(case)
    if is_it is None:
        return []
    seen = tuple(log.text for log in case.trace.logs)
    matches = [matched for line in case.trace.output if (matched := _LOG_LINE.match(line.text)) is not None]
    own = [line for line in matches if is_it(line.string) and not _ROS_LOGGER.match(line["logger"])]
    return [line for line in own if not line.string.endswith(seen)] if seen else own


def _is_own(case: Case, logger: str) -> bool:
    return logger in {node.strip("/").replace("/", ".") for node in case.trace.graph.nodes}


@mistake(
    "rosout-switched-off",
    explains=_LOGS,
    evidence=Evidence.RUN,
    says="{what} is logged by the node, but nothing that it logs reaches /rosout",
    do="Leave out enable_rosout=False, and --disable-rosout-logs among the arguments.",
    example=in_run(
        Symptom.NOT_LOGGED, what="the owner", value="Ada", output=["[INFO] [1700000000.0] [node]: owner: Ada"]
    ),
)
def rosout_off(case: Case) -> Iterator[Found]:
    """A node keeps its log to itself.

    With enable_rosout=False, a node makes no publisher for /rosout: its log appears only in its own terminal.

    Bad:

        super().__init__('bell', enable_rosout=False)

    Good:

        super().__init__('bell')

    See it: `ros2 topic echo /rosout` shows nothing from the node.
    """
    for line in _logged_elsewhere(case):
        if not case.trace.logs and _is_own(case, line["logger"]):
            yield Found({"what": case.about("what", "it")})


@mistake(
    "not-the-nodes-logger",
    name="not the node's logger",
    explains=_LOGS,
    evidence=Evidence.RUN,
    says="{what} is logged by {logger}, a logger that belongs to no node, so it does not reach /rosout",
    do="Use the logger of the node: its get_logger().",
    example=in_run(
        Symptom.NOT_LOGGED, what="the owner", value="Ada", output=["[INFO] [1700000000.0] [bell_log]: owner: Ada"]
    ),
)
def other_logger(case: Case) -> Iterator[Found]:
    """A message goes to a logger that belongs to no node.

    rclpy.logging.get_logger(name) returns a logger by its name. Only what a node's own logger and its children log is
    sent to /rosout; everything else is written to the terminal alone.

    Bad:

        rclpy.logging.get_logger('bell_log').info('ding')

    Good:

        self.get_logger().info('ding')

    See it: the message is in the terminal, but not in `ros2 topic echo /rosout`.
    """
    for line in _logged_elsewhere(case) if case.trace.graph.nodes else ():
        if case.trace.logs or not _is_own(case, line["logger"]):
            yield Found({"what": case.about("what", "it"), "logger": line["logger"] or "the root logger"})


@mistake(
    "nodes-logger-replaced",
    name="node's logger replaced",
    explains=_LOGS,
    says="{line} replaces the logger that rclpy's Node keeps under this name, and get_logger() returns yours: {code}",
    do="Keep your own logger under another name.",
)
def logger_replaced(case: Case) -> Iterator[Found]:
    """A node overwrites its own logger.

    rclpy's Node keeps its logger in self._logger. If one of Python's own loggers is assigned to it, get_logger()
    returns that, and nothing is sent to /rosout any more.

    Bad:

        self._logger = logging.getLogger('bell')

    Good:

        self._python_logger = logging.getLogger('bell')

    See it: `ros2 topic echo /rosout` shows nothing from the node.
    """
    for file in case.files:
        for node in file.nodes:
            match node:
                case ast.Assign(targets=[ast.Attribute(value=ast.Name(id="self"), attr="_logger")], value=value) if (
                    ast.unparse(value).startswith("logging.")
                ):
                    yield found(file, node)


@mistake(
    "log-level-raised",
    explains=_LOGS,
    says="{line} leaves out what is logged below that level: {code}",
    do="Leave the level alone, or log the message at a higher one.",
)
def level_raised(case: Case) -> Iterator[Found]:
    """A logger's level is raised.

    Messages below a logger's level are not made at all, neither in the terminal nor on /rosout. The default is INFO.

    Bad:

        self.get_logger().set_level(LoggingSeverity.ERROR)

    Good:

        self.get_logger().set_level(LoggingSeverity.INFO)

    See it: start it with `--ros-args --log-level debug`.
    """
    lowest = case.about("lowest_level", min((log.level for log in case.trace.logs), default=Level.FATAL))
    for file in case.files:
        for call in file.calls("set_level", "set_logger_level"):
            given = [*call.args, *(keyword.value for keyword in call.keywords)]
            name = ast.unparse(given[-1]).rpartition(".")[2] if given else ""
            level = _LEVELS.get(name)
            if level is None and given and isinstance(given[-1], ast.Name) and lowest == Level.FATAL:
                level = Level.FATAL
            if level is not None and lowest >= level and isinstance(file.statement(call), ast.Expr):
                yield found(file, call)


@mistake(
    "logged-at-debug",
    explains=_LOGS,
    says="{line} logs at the level DEBUG, which is not shown by default: {code}",
    do="Log it at INFO, the level for what everybody should see.",
)
def at_debug(case: Case) -> Iterator[Found]:
    """A message is logged at DEBUG.

    Loggers start at the level INFO: debug() makes no message at all unless somebody lowers the level.

    Bad:

        self.get_logger().debug('door open')

    Good:

        self.get_logger().info('door open')

    See it: start it with `--ros-args --log-level debug`.
    """
    calls = [(file, call) for file in case.files for call in file.calls("debug") if "log" in ast.unparse(call.func)]
    for file, call in calls:
        function = file.function_around(call) if case.about("wanted_hz") is not None else None
        timers_own = function in file.callbacks("create_timer") and not calls_in(function, *_SHOWN)
        if timers_own or case.about("only_debug") or not case.program.calls(*_SHOWN):
            yield found(file, call)
