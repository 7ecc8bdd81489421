"""Clients: how they find their services, and what keeps them from calling all of them.

A client that hears nothing often ends by an exception of its own. What keeps it from an answer explains that as well,
so it is asked before the exception.
"""

from __future__ import annotations

import ast
import difflib
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import Exit
from tutor.judge.tracebacks import last_traceback
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.services import found_service
from tutor.mistakes.themes.topics import name_difference
from tutor.ros_model import Graph, ServiceEndpoint
from tutor.source import NodeFile, called_name, calls_in

_CALLS = (Symptom.CALLS_MISSING,)
_PATIENT_S = 8.0  # a client that has waited for so long has given its services time to come up
_WAITS = ("wait_for_service", "service_is_ready", "server_is_ready", "get_service_names_and_types", "wait_for_services")
_EXITS = ("exit", "_exit", "quit", "SystemExit")
_ASKING = Graph(("/bell",), clients=(ServiceEndpoint("/opendoor", "std_srvs/srv/Trigger", "/bell"),))


def in_silence(case: Case) -> bool:
    """Whether an exception, if any, comes from a lack of answers: raised on purpose, or by None taken for an answer."""
    raised = last_traceback(case.trace)
    if raised is None:
        return not any("was never awaited" in line.text for line in case.trace.output)
    own = raised.own(case.trace.folder)
    on_purpose = own is not None and own.code.startswith(("raise ", "assert "))
    none = "'NoneType'" in raised.message and "context manager" not in raised.message
    return on_purpose or none or raised.type.endswith(("Timeout", "TimeoutError"))


def requests(file: NodeFile) -> list[ast.Call]:
    """The calls that send a request to a service."""
    sent = [call for call in file.calls("call_async", "call") if isinstance(call.func, ast.Attribute)]
    return [call for call in sent if not ast.unparse(call.func).startswith(("subprocess.", "self.call", "super()"))]


@mistake(
    "needs-arguments",
    explains=_CALLS,
    evidence=Evidence.PROCESS,
    says="the program is run without arguments, and then ends with {exit}: {what}",
    do="Let it do its work without arguments as well, with values of its own.",
    example=in_run(Symptom.CALLS_MISSING, exit=Exit(2, None, 0.2), calls=0),
)
def needs_arguments(case: Case) -> Iterator[Found]:
    """A program does nothing without arguments.

    A program that is started by another, such as a launch file, gets the arguments that the other knows of, often none.
    A default for each makes it usable at once.

    Bad:

        if len(sys.argv) < 2:
            sys.exit(2)

    Good:

        room = sys.argv[1] if len(sys.argv) > 1 else 'hall'

    See it: start it without arguments, then `echo $?`.
    """
    ended = case.trace.exit
    if ended is None or case.about("calls") != 0 or case.exceptions:
        return
    errors = [line.text for line in case.trace.output if line.stream == "stderr" and " error: " in line.text]
    if ended.code == 2 and errors:
        yield Found({"exit": ended, "what": errors[-1].rpartition(" error: ")[2]})
    for file in case.files:
        for node in file.nodes:
            if isinstance(node, ast.If) and "argv" in ast.unparse(node.test) and _ends(node):
                yield found(file, node, exit=ended, what=f"line {node.lineno} tests for them")


def _ends(test: ast.If) -> bool:
    ends = [branch[-1] for branch in (test.body, test.orelse) if branch]
    return any(isinstance(end, ast.Return | ast.Raise) or bool(calls_in(end, *_EXITS)) for end in ends)


@mistake(
    "service-not-offered",
    explains=_CALLS,
    evidence=Evidence.PROCESS,
    says="the client asks for {given}, {what}",
    do="Make the client with the name and the type of the service that is there.",
    example=in_run(Symptom.CALLS_MISSING, graph=_ASKING, services=("/open_door",), type="std_srvs/srv/Trigger"),
)
def service_not_offered(case: Case) -> Iterator[Found]:
    """A client asks for a service that nobody offers.

    A client reaches a service only if name and type are the same, letter by letter. Nothing tells it that there is a
    similar one: it just waits.

    Bad:

        self.door = self.create_client(Trigger, 'opendoor')

    Good:

        self.door = self.create_client(Trigger, 'open_door')

    See it: `ros2 service list -t`.

    Lesson: i1.3, the client.
    """
    services, wanted = case.about("services", ()), case.about("type")
    own = [client for client in case.trace.graph.clients if not client.is_standard]
    for client in sorted(own, key=lambda client: client.name) if services and in_silence(case) else ():
        given = client.name
        if given not in services:
            near = max(services, key=lambda name: difflib.SequenceMatcher(None, name, given).ratio())
            what = f"which nobody offers; there is {near}, for one: {name_difference(given, near)}"
            yield found_service(case, given, given=given, what=what)
        elif wanted is not None and client.type != wanted:
            yield found_service(
                case, given, given=given, what=f"with the type {client.type}, but it is there with {wanted}"
            )


@mistake(
    "wait-turned-around",
    explains=_CALLS,
    evidence=Evidence.PROCESS,
    slip=True,
    says="{line} keeps waiting as long as the service is there: {code}",
    do="Put not in front of the condition.",
)
def wait_turned_around(case: Case) -> Iterator[Found]:
    """A client waits while the service is there.

    wait_for_service() is true once the service is there. A loop that waits has to go on while it is not.

    Bad:

        while door.wait_for_service(timeout_sec=1.0):
            print('waiting')

    Good:

        while not door.wait_for_service(timeout_sec=1.0):
            print('waiting')

    See it: it waits forever once the service is there.
    """
    for file in case.files if in_silence(case) else ():
        for loop in file.nodes:
            match loop:
                case ast.While(test=ast.Call() as test) if called_name(test) in _WAITS:
                    if not any(isinstance(node, ast.Break | ast.Return) for node in ast.walk(loop)):
                        yield found(file, loop)


@mistake(
    "service-not-waited-for",
    explains=_CALLS,
    evidence=Evidence.PROCESS,
    says="{line} sends a request without knowing whether there is a server; without one, it is lost: {code}",
    do="Wait for the service before the first request.",
)
def not_waited_for(case: Case) -> Iterator[Found]:
    """A request is sent before there is a server.

    Programs start in any order, and even a running server takes a moment to be found. A request that is sent before
    that is lost without a word: no answer ever comes.

    Bad:

        door = node.create_client(Trigger, 'open_door')
        future = door.call_async(Trigger.Request())

    Good:

        door = node.create_client(Trigger, 'open_door')
        door.wait_for_service()
        future = door.call_async(Trigger.Request())

    See it: start the client first, the server a second later.

    Lesson: i1.3, the client.
    """
    if case.program.mentions(*_WAITS) or not in_silence(case):
        return
    for file in case.files:
        yield from (found(file, call) for call in requests(file))


@mistake(
    "waits-too-short-a-time",
    explains=_CALLS,
    evidence=Evidence.PROCESS,
    says="{line} gives up before the service is there, and after {seconds:.1f} s the program has ended: {code}",
    do="Wait longer before you give up, and look at what the wait returns.",
    example=in_run(Symptom.CALLS_MISSING, exit=Exit(1, None, 0.9), calls=0),
)
def waits_too_short(case: Case) -> Iterator[Found]:
    """A client gives up before its service is there.

    wait_for_service(timeout_sec=…) returns False when the time is up, and the program goes on. Servers that start
    together with the client take a second or more to be found.

    Bad:

        if not door.wait_for_service(timeout_sec=0.1):
            sys.exit(1)
        door.call_async(Trigger.Request())

    Good:

        if not door.wait_for_service(timeout_sec=10.0):
            sys.exit(1)
        door.call_async(Trigger.Request())

    See it: start the client first, the server a second later.
    """
    ended = case.trace.exit
    if ended is None or ended.after_s > _PATIENT_S or case.about("calls") != 0 or not in_silence(case):
        return
    for file in case.files if any(map(requests, case.files)) else ():
        for call in file.calls(*_WAITS):
            if call.args or call.keywords or not called_name(call).startswith("wait"):  # else it never gives up
                yield found(file, call, seconds=ended.after_s)


@mistake(
    "return-in-the-loop",
    explains=_CALLS,
    says="{line} ends the loop in line {loop} in its first round: {code}",
    do="Move it below the loop.",
    example=in_run(Symptom.CALLS_MISSING, calls=1),
)
def return_in_loop(case: Case) -> Iterator[Found]:
    """A return at the end of a loop's body ends the loop.

    return leaves the function at once, even from inside a loop. At the end of the loop's body, it does so in the first
    round.

    Bad:

        for door in self.doors:
            self.open(door)
            return True

    Good:

        for door in self.doors:
            self.open(door)
        return True

    See it: only the first door opens.
    """
    for file in case.files if case.about("calls") == 1 else ():
        for loop in file.nodes:
            if isinstance(loop, ast.For) and len(loop.body) > 1 and isinstance(loop.body[-1], ast.Return):
                yield found(file, loop.body[-1], loop=loop.lineno)


@mistake(
    "client-overwritten-in-a-loop",
    explains=_CALLS,
    says="{line} keeps every client under the same name, {name}, so only the last one is left: {code}",
    do="Keep the clients in a list or a dict, or use each one within the loop.",
)
def client_overwritten(case: Case) -> Iterator[Found]:
    """A loop makes several clients, and keeps only the last.

    An assignment replaces what a name stood for. After a loop that assigns to the same name in each round, the name
    stands for the last client.

    Bad:

        for room in ('hall', 'cellar'):
            self.door = self.create_client(Trigger, room)
        self.door.call_async(Trigger.Request())

    Good:

        for room in ('hall', 'cellar'):
            self.doors[room] = self.create_client(Trigger, room)
        self.doors['hall'].call_async(Trigger.Request())

    See it: all requests go to the last service.
    """
    for file in case.files:
        for loop in (node for node in file.nodes if isinstance(node, ast.For)):
            called = [function for call in calls_in(loop) if (function := file.function(call.func)) is not None]
            if any(calls_in(part, "call_async", "call", "append") for part in (loop, *called)):
                continue
            for call in calls_in(loop, "create_client"):
                name = file.assigned_to(call)
                if name and not name.endswith("]"):
                    yield found(file, call, name=name)
