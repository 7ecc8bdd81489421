"""Services: names, types and QoS, and what destroys them."""

from __future__ import annotations

import ast
import difflib
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.topics import name_difference
from tutor.ros_model import Graph, ServiceEndpoint
from tutor.source import NodeFile

_UNREACHED = (Symptom.SERVICE_MISSING, Symptom.NO_ANSWER, Symptom.CALLS_MISSING)


def offering(name: str, type: str = "std_srvs/srv/Trigger", **qos: str) -> Graph:
    """A graph in which one node offers a service, for the examples."""
    return Graph(("/node",), servers=(ServiceEndpoint(name, type, "/node", **qos),))


def services_of(case: Case) -> list[ServiceEndpoint]:
    """The services that the program offers, apart from those that every node has."""
    return [server for server in case.trace.graph.servers if not server.is_standard]


def place_of(case: Case, name: str) -> tuple[NodeFile, ast.Call] | None:
    """The call that makes the service with this name, or the only one."""
    calls = [(file, call) for file in case.files for call in file.calls("create_service", "create_client")]
    named = [(file, call) for file, call in calls if name.rpartition("/")[2] in file.line(call.lineno)]
    return next(iter(named or (calls if len(calls) == 1 else [])), None)


def found_service(case: Case, name: str, **words: object) -> Found:
    """A mistake at the call that makes this service or its client, if it is clear which one does."""
    place = place_of(case, name)
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
    for server in services_of(case):
        if server.name == service and wanted is not None and server.type != wanted:
            yield found_service(case, service, service=service, given=server.type, wanted=wanted)


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
    graph, asked = case.trace.graph, case.about("service")
    servers = [server for server in graph.servers if server.name == asked] or graph.servers
    for endpoint in (*servers, *graph.clients):
        if not endpoint.is_standard:
            words = {"service": endpoint.name}
            if endpoint.reliability == "best_effort":
                yield found_service(
                    case, endpoint.name, policy="reliability", own="best effort", default="reliable", **words
                )
            if endpoint.durability == "transient_local":
                own = "transient local"
                yield found_service(case, endpoint.name, policy="durability", own=own, default="volatile", **words)


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
    offered = [server for server in services_of(case) if server.name not in taken]
    same = [server for server in offered if wanted_type is None or server.type == wanted_type]
    names = sorted({server.name for server in same or offered})
    if len(taken) > 1:  # one of several services: another one of a name that has nothing to do with it is not meant
        names = [name for name in names if _is_similar(name, service)]
    if names:
        given = max(names, key=lambda name: difflib.SequenceMatcher(None, name, service).ratio())
        yield found_service(case, given, given=given, wanted=service, difference=name_difference(given, service))


def _is_similar(given: str, wanted: str) -> bool:
    given, wanted = given.casefold(), wanted.casefold()
    return given.endswith(wanted) or wanted.endswith(given) or wanted[1:4] in given


@mistake(
    "service-destroyed",
    explains=_UNREACHED,
    says="{line} is in __del__, which Python calls once nothing refers to the object any more: {code}",
    do="Leave the service alone there: the node destroys it when the node itself goes.",
)
def destroyed(case: Case) -> Iterator[Found]:
    """A service is destroyed along with the object that made it.

    Python calls __del__ when nothing refers to an object any more, for instance when its variable gets another value. A
    service destroyed there is gone, although the node lives on.

    Bad:

        class Door:
            def __del__(self):
                self.node.destroy_service(self.service)

    Good:

        class Door:
            def close(self):
                self.node.destroy_service(self.service)

    See it: `ros2 service list` shows some of the services only.
    """
    for file in case.files:
        for call in file.calls("destroy_service"):
            function = file.function_around(call)
            if function is not None and function.name == "__del__":
                yield found(file, call)
