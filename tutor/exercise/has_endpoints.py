"""A form: a system has the nodes and endpoints that were agreed on."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass

from tutor.exercise.system_run import SystemForm, SystemRun
from tutor.judge.symptom import Symptom
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import counted
from tutor.ros_model import Graph, TopicEndpoint


@dataclass(frozen=True)
class Endpoint:
    """A publisher or a subscription that a node of a system must have.

    `node`, `topic` and `type`: full names. `reliability` ("reliable" or "best_effort") and `durability` ("volatile" or
    "transient_local"): its QoS; "" for any.
    """

    node: str
    topic: str
    type: str
    reliability: str = ""
    durability: str = ""

    def difference(self, found: tuple[TopicEndpoint, ...], nodes: Collection[str] = ()) -> str:
        """What differs in the nearest of these endpoints; "" if one of them is as it must be.

        `nodes`: which others have one there by right.
        """
        own = [endpoint for endpoint in found if (endpoint.node, endpoint.topic) == (self.node, self.topic)]
        if not own:
            others = sorted({endpoint.node for endpoint in found if endpoint.topic == self.topic} - set(nodes))
            return "is not there" + (f"; {' and '.join(others)} has one" if others else "")
        differences = [self._difference(endpoint) for endpoint in own]
        return "" if "" in differences else differences[0]

    def _difference(self, found: TopicEndpoint) -> str:
        if found.type != self.type:
            return f"has the type {found.type}"
        if self.reliability and found.qos.reliability != self.reliability:
            return f"is {found.qos.reliability.replace('_', ' ')}"
        if self.durability and found.qos.durability != self.durability:
            return f"is {found.qos.durability.replace('_', ' ')}"
        return ""


@dataclass(frozen=True)
class HasEndpoints(SystemForm):
    """A system has these publishers and subscriptions, with their types and QoS, as agreed on with others.

    What it has besides does not matter. A difference is reported plainly: where that would give a fault away, let this
    criterion come `after` the one that asks for it. The exercise's program must be a `LaunchFile`:

        HasEndpoints("interfaces", publishers=(Endpoint("/lamp", "/lamp/state", "std_msgs/msg/Bool"),))
    """

    publishers: tuple[Endpoint, ...] = ()
    subscriptions: tuple[Endpoint, ...] = ()

    @property
    def nodes(self) -> int:
        return len({endpoint.node for endpoint in (*self.publishers, *self.subscriptions)})

    def judge(self, seen: SystemRun) -> Verdict:
        number = len(self.publishers) + len(self.subscriptions)
        expected = f"{counted(number, 'endpoint')} of {counted(self.nodes, 'node')}, as they were handed over"
        differences = list(self._differences(seen.trace.graph))
        if not differences:
            return passed(expected, "all are there, with their types and QoS")
        says = f"{differences[0]}, unlike what was handed over"
        do = "Undo what the repair does not need, and look again at which side is as it was agreed on."
        why = Symptom.SYSTEM_CHANGED.seen(seen.trace, says=says, do=do)
        return failed(expected, differences[0], why if not seen.broken else seen.not_as_it_should(says), differences)

    def _differences(self, graph: Graph) -> Iterator[str]:
        for what, wanted, found in (
            ("publisher", self.publishers, graph.publishers),
            ("subscription", self.subscriptions, graph.subscriptions),
        ):
            for endpoint in wanted:
                by_right = [other.node for other in wanted if other.topic == endpoint.topic]
                if difference := endpoint.difference(found, by_right):
                    yield f"the {what} of {endpoint.node} on {endpoint.topic} {difference}"
