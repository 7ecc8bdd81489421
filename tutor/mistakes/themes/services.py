"""Services: names, types and QoS, and what is wrong with an answer."""

from __future__ import annotations

import ast
import difflib
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import CallAnswer
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.topics import name_difference
from tutor.ros_model import Graph, ServiceEndpoint
from tutor.source import NodeFile, argument, calls_in

_UNREACHED = (Symptom.SERVICE_MISSING, Symptom.NO_ANSWER, Symptom.CALLS_MISSING)


def offering(name: str, type: str = "std_srvs/srv/Trigger", **qos: str) -> Graph:
    """A graph in which one node offers a service, for the examples."""
    return Graph(("/node",), servers=(ServiceEndpoint(name, type, "/node", **qos),))


def _offered(case: Case) -> list[ServiceEndpoint]:
    return [server for server in case.trace.graph.servers if not server.is_standard]


def _place(case: Case, name: str) -> tuple[NodeFile, ast.Call] | None:
    """The call that makes the service with this name, or the only one."""
    calls = [(file, call) for file in case.files for call in file.calls("create_service", "create_client")]
    named = [(file, call) for file, call in calls if name.rpartition("/")[2] in file.line(call.lineno)]
    return next(iter(named or (calls if len(calls) == 1 else [])), None)


def _found(case: Case, name: str, **words: object) -> Found:
    place = _place(case, name)
    return found(*place, **words) if place is not None else Found(dict(words))


@mistake(
    "wrong-service-type",
    name="wrong type",
    explains=(Symptom.SERVICE_MISSING,),
    evidence=Evidence.RUN,
    says="{service} has the type {given}, not {wanted}",
    do="Create the service with the type that is asked for, and import it from its package.",
    example=in_run(
        Symptom.SERVICE_MISSING, graph=offering("/open_door"), service="/open_door", type="std_srvs/srv/SetBool"
    ),
)
def wrong_type(case: Case) -> Iterator[Found]:
    """The service is right, but its type is not.

    A client reaches a service only if name and type are the same. The type decides which fields a request and a
    response have.

    Bad:

        self.create_service(Trigger, 'open_door', self.open_the_door)

    Good:

        self.create_service(SetBool, 'open_door', self.open_the_door)

    See it: `ros2 service list -t`.
    """
    service, wanted = case.about("service"), case.about("type")
    for server in _offered(case):
        if server.name == service and wanted is not None and server.type != wanted:
            yield _found(case, service, service=service, given=server.type, wanted=wanted)


@mistake(
    "incompatible-qos-of-a-service",
    name="incompatible QoS",
    explains=(*_UNREACHED, Symptom.WRONG_ANSWER),
    evidence=Evidence.RUN,
    says="{service} has the {policy} {own}, and the other side {default}, the default of services: they never meet",
    do="Leave out the QoS profile: the default is right for services.",
    example=in_run(
        Symptom.SERVICE_MISSING, graph=offering("/open_door", reliability="best_effort"), service="/open_door"
    ),
)
def service_qos(case: Case) -> Iterator[Found]:
    """A service has a QoS that clients do not match.

    Services are reliable and volatile by default, and so are the clients of tools and other nodes. With best effort, or
    transient local, on one side only, DDS may not connect the two.

    Bad:

        self.create_service(Trigger, 'open_door', self.open_the_door, qos_profile=qos_profile_sensor_data)

    Good:

        self.create_service(Trigger, 'open_door', self.open_the_door)

    See it: `ros2 service call` waits forever.
    """
    graph = case.trace.graph
    for endpoint in (*graph.servers, *graph.clients):
        if not endpoint.is_standard:
            words = {"service": endpoint.name}
            if endpoint.reliability == "best_effort":
                yield _found(case, endpoint.name, policy="reliability", own="best effort", default="reliable", **words)
            if endpoint.durability == "transient_local":
                own = "transient local"
                yield _found(case, endpoint.name, policy="durability", own=own, default="volatile", **words)


@mistake(
    "wrong-service-name",
    explains=(Symptom.SERVICE_MISSING,),
    evidence=Evidence.RUN,
    says="there is {given}, not {wanted}: {difference}",
    do="Use exactly the name that is asked for where the service is created.",
    example=in_run(Symptom.SERVICE_MISSING, graph=offering("/opendoor"), service="/open_door"),
)
def wrong_name(case: Case) -> Iterator[Found]:
    """A service has another name.

    Names are compared letter by letter. A name without a leading slash is relative to the node's namespace; with a
    leading ~, the node's name comes before it as well.

    Bad:

        self.create_service(Trigger, '~/open_door', self.open_the_door)

    Good:

        self.create_service(Trigger, 'open_door', self.open_the_door)

    See it: `ros2 service list`.
    """
    service, wanted_type = case.about("service"), case.about("type")
    taken = set(case.about("services", ()))
    if service is None or any(server.name == service for server in case.trace.graph.servers):
        return
    offered = [server for server in _offered(case) if server.name not in taken]
    same = [server for server in offered if wanted_type is None or server.type == wanted_type]
    names = sorted({server.name for server in same or offered})
    if names:
        given = max(names, key=lambda name: difflib.SequenceMatcher(None, name, service).ratio())
        yield _found(case, given, given=given, wanted=service, difference=name_difference(given, service))


@mistake(
    "answered-too-early",
    explains=[Symptom.WRONG_ANSWER],
    says="{line} does the work outside the callback, which answers at once, with nothing filled in yet: {code}",
    do="Let the callback itself do the work, and return the response when the work is done.",
)
def answered_early(case: Case) -> Iterator[Found]:
    """A service answers before its work is done.

    The response goes out when the callback returns it. A thread or task that fills it in later fills in an object that
    nobody sends any more.

    Bad:

        def __init__(self):
            self.create_service(Trigger, 'open_door', self.open_the_door)

        def open_the_door(self, request, response):
            Thread(target=self.turn_the_key, args=(response,)).start()
            return response

    Good:

        def __init__(self):
            self.create_service(Trigger, 'open_door', self.open_the_door)

        def open_the_door(self, request, response):
            self.turn_the_key(response)
            return response

    See it: `ros2 service call` answers at once.
    """
    for file in case.files if case.about("early", True) else ():
        for service in file.calls("create_service"):
            callback = file.function(argument(service, "callback"))
            for call in calls_in(callback, "Thread", "Timer", "submit", "create_task"):
                yield found(file, call)


@mistake(
    "response-field-not-set",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.SYMPTOM,
    says="{service} answers 0 instead of {wanted}: a field that is never set is 0",
    do="Put the result into the response's field that the type has for it.",
    example=in_run(
        Symptom.WRONG_ANSWER,
        service="/count",
        wanted=7,
        answer=CallAnswer("/count", {}, {"sum": 0}, 0.0, 0.1),
    ),
)
def field_not_set(case: Case) -> Iterator[Found]:
    """A response is returned unchanged.

    The callback is given a response whose fields are 0, false or empty. What it computes reaches the caller only if it
    is put into one of these fields.

    Bad:

        def count(self, request, response):
            total = request.a + request.b
            return response

    Good:

        def count(self, request, response):
            response.sum = request.a + request.b
            return response

    See it: `ros2 interface show TYPE` lists the fields.
    """
    answer, wanted = case.about("answer"), case.about("wanted")
    response = answer.response if answer is not None else None
    if response and wanted not in (None, 0) and all(value == 0 for value in response.values()):
        yield Found({"service": case.about("service", "the service"), "wanted": wanted})


@mistake(
    "shared-state",
    explains=[Symptom.WRONG_ANSWER],
    evidence=Evidence.RUN,
    says="one call was answered with the result of another that was made at the same time",
    do="Keep what belongs to one call in local variables of the callback.",
    example=in_run(Symptom.WRONG_ANSWER, shared=True),
)
def shared_state(case: Case) -> Iterator[Found]:
    """Calls that run at the same time share a variable.

    With several threads, a callback can run several times at once. All of these runs share the node's attributes: the
    second call overwrites what the first has put there.

    Bad:

        def open_the_door(self, request, response):
            self.who = request.data
            time.sleep(3.0)
            response.message = f'hello {self.who}'
            return response

    Good:

        def open_the_door(self, request, response):
            time.sleep(3.0)
            response.message = f'hello {request.data}'
            return response

    See it: call the service twice at once, with different values.
    """
    if case.about("shared"):
        yield Found()
