"""Setting a node up: what is never called, called twice, waited for, or never activated."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.ros_model import Graph, ServiceEndpoint
from tutor.source import Function, NodeFile, called_name, calls_in, last_name

_MISSING = (Symptom.NO_MESSAGES, Symptom.NOTHING_RECEIVED, Symptom.SERVICE_MISSING, Symptom.CALLS_MISSING)
_CREATORS = {
    Symptom.NO_MESSAGES: ("create_publisher", "create_timer"),
    Symptom.NOTHING_RECEIVED: ("create_subscription",),
    Symptom.SERVICE_MISSING: ("create_service",),
    Symptom.CALLS_MISSING: ("create_client",),
}
CHANGE_STATE = "lifecycle_msgs/srv/ChangeState"
TRANSITION_CALLBACKS = ("on_configure", "on_activate", "on_deactivate", "on_cleanup", "on_shutdown", "on_error")
"""The methods of a lifecycle node that rclpy calls."""

_WARNING = re.compile(r"coroutine '(?:[\w<>]+\.)*(\w+)' was never awaited")


@mistake(
    "lifecycle-node-not-activated",
    explains=(*_MISSING, Symptom.NO_ANSWER, Symptom.NOT_LOGGED, Symptom.STANDS_STILL, Symptom.CHANGE_IGNORED),
    evidence=Evidence.RUN,
    says="{node} is a lifecycle node, which works only once it is configured and activated{what}",
    do="Use an ordinary Node, or configure and activate this one before it is spun.",
    example=in_run(
        Symptom.NO_MESSAGES,
        graph=Graph(
            ("/bell",), servers=(ServiceEndpoint("/bell/change_state", "lifecycle_msgs/srv/ChangeState", "/bell"),)
        ),
    ),
)
def not_activated(case: Case) -> Iterator[Found]:
    """A lifecycle node was never activated.

    A lifecycle node begins "unconfigured", and its publishers are switched off until something has configured and
    activated it: a launch file, `ros2 lifecycle set`, or the program itself. An on_activate() of your own has to call
    that of the base class, which switches them on.

    Bad:

        class Bell(LifecycleNode):
            def on_activate(self, state):
                return TransitionCallbackReturn.SUCCESS

    Good:

        class Bell(LifecycleNode):
            def on_activate(self, state):
                return super().on_activate(state)

        bell = Bell()
        bell.trigger_configure()
        bell.trigger_activate()

    See it: `ros2 service call NODE/get_state lifecycle_msgs/srv/GetState`.
    """
    nodes = [server.node for server in case.trace.graph.servers if server.type == CHANGE_STATE]
    if not nodes or case.about("lifecycle"):  # the criterion itself asks for each transition
        return
    own = next((function for file in case.files for function in file.functions_named("on_activate")), None)
    lacks_super = own is not None and not calls_in(own, "on_activate")
    if lacks_super:
        yield Found({"node": nodes[0], "what": ": its on_activate does not call that of the base class"})
    elif not case.program.mentions("trigger_activate"):
        yield Found({"node": nodes[0], "what": ", but nothing does that here"})


@mistake(
    "setup-not-called",
    explains=_MISSING,
    says="{line} is in {function}, which nothing calls: {code}",
    do="Call {function} while the node is set up.",
    example=in_run(Symptom.NO_MESSAGES),
)
def setup_not_called(case: Case) -> Iterator[Found]:
    """What sets the node up is never called.

    __init__ runs when the node is made. A method of another name runs only if something calls it.

    Bad:

        class Bell(Node):
            def __init__(self):
                super().__init__('bell')

            def set_up(self):
                self.ring = self.create_publisher(Bool, 'ring', 10)

    Good:

        class Bell(Node):
            def __init__(self):
                super().__init__('bell')
                self.set_up()

            def set_up(self):
                self.ring = self.create_publisher(Bool, 'ring', 10)

    See it: `ros2 node info NODE` lacks what should be there.
    """
    for file in case.files:
        for call in file.calls(*_CREATORS.get(case.symptom, ())):
            function = file.function_around(call)
            # Functions of other files may be what setup.py or a launch file starts.
            if function is None or (file is not case.file and file.class_of(function) is None):
                continue
            if function.name in TRANSITION_CALLBACKS and _is_lifecycle_node(case):
                continue
            if not _is_mentioned(case, file, function):
                yield found(file, call, function=f"{function.name}()")


def _is_lifecycle_node(case: Case) -> bool:
    return any(server.type == CHANGE_STATE for server in case.trace.graph.servers)


def _is_mentioned(case: Case, file: NodeFile, function: Function) -> bool:
    if function.name.startswith("__") or function.decorator_list:
        return True
    modules = {alias.asname or alias.name for statement, alias in file.imports if isinstance(statement, ast.Import)}
    for node in case.program.nodes():
        match node:
            case ast.Attribute(value=value, attr=name) if name == function.name and ast.unparse(value) not in modules:
                return True
            case ast.Name(id=name) | ast.Constant(value=name) if name == function.name:
                return True
    return False


@mistake(
    "waits-for-a-service",
    explains=(*_MISSING, Symptom.NO_ANSWER),
    evidence=Evidence.RUN,
    says="{line} waits for {service}, which nobody offers, before it goes on: {code}",
    do="Make everything else first, and wait for the service only where it is needed, with a time limit.",
    remark="without a timeout_sec, this waits for ever and says nothing while nobody offers the service.",
    example=in_run(
        Symptom.NO_MESSAGES,
        graph=Graph(("/bell",), clients=(ServiceEndpoint("/open_door", "std_srvs/srv/Trigger", "/bell"),)),
    ),
)
def waits_for_service(case: Case) -> Iterator[Found]:
    """A node waits for a service that nobody offers.

    Without a timeout_sec, wait_for_service() returns once the service is there, and a loop around it ends then. While
    nobody offers it, the program stays there, and nothing below it is made.

    Bad:

        while not self.door.wait_for_service():
            self.get_logger().info('waiting')

    Good:

        if not self.door.wait_for_service(timeout_sec=1.0):
            self.get_logger().warning('nobody opens the door yet')

    See it: `ros2 service list`.
    """
    offered = {*(server.name for server in case.trace.graph.servers), *case.about("services", ())}
    awaited = sorted({client.name for client in case.trace.graph.clients if client.name not in offered})
    for file in case.files if awaited or case.passed else ():
        unlimited = [call for call in file.calls("wait_for_service") if _is_unlimited(call)]
        loops = [node for node in file.nodes if isinstance(node, ast.While)]
        asking = [loop for loop in loops if calls_in(loop.test, "wait_for_service", "service_is_ready")]
        for node in unlimited if case.passed else (*unlimited, *asking):
            yield found(file, node, service=next(iter(awaited), "a service"))


def _is_unlimited(wait: ast.Call) -> bool:
    given = [*wait.args, *(keyword.value for keyword in wait.keywords)]
    return all(isinstance(value, ast.Constant) and value.value is None for value in given)


@mistake(
    "coroutine-not-awaited",
    explains=(*_MISSING, Symptom.NO_ANSWER, Symptom.WRONG_ANSWER, Symptom.NOT_LOGGED, Symptom.CHANGE_IGNORED),
    evidence=Evidence.RUN,
    says="{function} is an async def: calling it only makes a coroutine, and nothing in it runs",
    do="Await it, or make it a plain def if it awaits nothing itself.",
    example=in_run(Symptom.NO_MESSAGES, output=["RuntimeWarning: coroutine 'Bell.ring' was never awaited"]),
)
def not_awaited(case: Case) -> Iterator[Found]:
    """A coroutine is made, but nothing awaits it.

    Calling an async def runs none of its lines; it returns a coroutine, which runs when it is awaited. rclpy awaits a
    callback that is itself an async def, but not what a lambda or a wrapper returns.

    Bad:

        self.create_timer(1.0, lambda: self.ring())

        async def ring(self):
            self.bell.publish(Bool(data=True))

    Good:

        self.create_timer(1.0, self.ring)

        async def ring(self):
            self.bell.publish(Bool(data=True))

    See it: Python warns "coroutine … was never awaited".
    """
    for line in case.trace.output:
        if matched := _WARNING.search(line.text):
            name = matched[1]
            for file in case.files:
                yield from (found(file, function, function=name) for function in file.functions_named(name))
            yield Found({"function": name})


@mistake(
    "set-up-twice",
    explains=(Symptom.WRONG_RATE, Symptom.WRONG_LOG, Symptom.BAD_VALUE_ACCEPTED),
    says="{line} calls {method}, which {base}'s constructor has called already: {code}",
    do="Leave that call to the base class.",
)
def set_up_twice(case: Case) -> Iterator[Found]:
    """A class repeats what its base class has done.

    super().__init__() runs the constructor of the base class, and all that it calls. Calling the same method again
    makes a second timer, or a second subscription.

    Bad:

        class Bell(Node):
            def __init__(self):
                self.start()

            def start(self):
                self.create_timer(1.0, self.ring)

        class Gong(Bell):
            def __init__(self):
                super().__init__()
                self.start()

    Good:

        class Bell(Node):
            def __init__(self):
                self.start()

            def start(self):
                self.create_timer(1.0, self.ring)

        class Gong(Bell):
            def __init__(self):
                super().__init__()

    See it: `ros2 topic hz TOPIC` gives twice the rate.
    """
    classes = {node.name: node for node in case.program.nodes() if isinstance(node, ast.ClassDef)}
    for file in case.files:
        for owner in (node for node in file.nodes if isinstance(node, ast.ClassDef)):
            for base in (classes[name] for name in map(last_name, owner.bases) if name in classes):
                done = {name for name, _ in _own_calls(base)}
                for name, call in _own_calls(owner):
                    if name in done and _reaches(name, list(classes.values())):
                        yield found(file, call, method=f"{name}()", base=base.name)


def _methods(owner: ast.ClassDef) -> dict[str, Function]:
    return {node.name: node for node in owner.body if isinstance(node, Function)}


def _own_calls(owner: ast.ClassDef) -> Iterator[tuple[str, ast.Expr]]:
    """The statements in a class's `__init__` that call a method of its own: its name, and the statement."""
    made = _methods(owner).get("__init__")
    for statement in made.body if made is not None else ():
        match statement:
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="self"), attr=name))):
                yield name, statement


def _reaches(name: str, classes: list[ast.ClassDef]) -> bool:
    """Whether a method of this name makes a timer or a subscription, if only by way of others."""
    todo, seen = [name], set[str]()
    while todo:
        current = todo.pop()
        seen.add(current)
        for method in (methods[current] for owner in classes if current in (methods := _methods(owner))):
            if calls_in(method, "create_timer", "create_subscription"):
                return True
            todo += {called_name(call) for call in calls_in(method)} - seen
    return False
