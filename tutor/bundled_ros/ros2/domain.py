"""A node on the user's domain, and how long it waits until discovery is complete.

There is no daemon that has been watching the domain. Fast DDS opens separate UDP ports for each participant (usually
one per process), so the participants on this machine can be counted without asking them; discovery is complete once
as many have been discovered.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from tutor.errors import CommandError
from tutor.ros.domain import participants_here

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.topic_endpoint_info import TopicEndpointInfo

T = TypeVar("T")

LIMIT_S = 4.0
"""Upper bound of a wait for participants whose ports are open but which have not answered.

If the answer to our announcement gets lost, their own next announcement comes within 3 s.
"""

_POLL_S = 0.01
# How long the graph must have been unchanged before it counts as complete:
_QUIET_S = 0.05  # usually: related changes arrive within milliseconds
_SURE_QUIET_S = 0.2  # before something is reported as missing
_LONG_QUIET_S = 1.5  # while node names are unknown: a DDS program that is not a ROS node never gets one
_UNCOUNTED_QUIET_S = 0.5  # if the participants cannot be counted
_SLOW_QUIET_S = 1.0  # upper bound on a slow machine
_UNKNOWN_NODE_NAME = "_NODE_NAME_UNKNOWN_"
_HOST_BYTES = 4  # length of the part of a participant's id that identifies its machine
_DISCOVERY_TOPIC = "ros_discovery_info"  # the DDS topic on which each participant lists its nodes


@contextmanager
def join_domain(arguments: argparse.Namespace, *, name: str | None = None) -> Iterator[Domain]:
    """Create a node on the domain for the duration of the block.

    Unless given a name, the node is hidden, like those of ros2cli. Nothing spins it: a verb with subscriptions, timers
    or clients spins it itself. Raises CommandError for an invalid `name`.
    """
    import rclpy
    from rclpy.exceptions import InvalidNodeNameException
    from rclpy.parameter import Parameter

    from tutor.ros.participant import new_context

    # Python's own handler raises KeyboardInterrupt; rclpy's would shut the context down in the middle of a call.
    context = new_context()
    try:
        node = rclpy.create_node(
            name or f"_ros2cli_{os.getpid()}",
            context=context,
            use_global_arguments=False,
            start_parameter_services=False,
            parameter_overrides=[
                Parameter("use_sim_time", value=bool(getattr(arguments, "use_sim_time", False))),
                Parameter("start_type_description_service", value=False),
            ],
        )
        spin_time = getattr(arguments, "spin_time", None)
        yield Domain(node, LIMIT_S if spin_time is None else spin_time)
        node.destroy_node()
    except InvalidNodeNameException as error:
        raise CommandError(str(error)) from error
    finally:
        context.try_shutdown()


@dataclass(slots=True)
class Domain:
    """The domain as `node` sees it. `limit_s` bounds each wait for discovery."""

    node: Node
    limit_s: float = LIMIT_S

    def wait_for_discovery(self) -> None:
        """Wait until everything on the domain has been discovered."""
        self._poll_until_discovered(lambda: None, _QUIET_S)

    def discover_publishers(self, topic: str) -> list[TopicEndpointInfo]:
        """Return the publishers of a topic once all are discovered. Their nodes' names may still be unknown."""
        ask = self.node.get_publishers_info_by_topic
        self._poll_until_discovered(
            lambda: None, _QUIET_S, lambda: (sorted(self._discovered_participants()), len(ask(topic))), named=False
        )
        return list(ask(topic))

    def find(self, look: Callable[[], T | None]) -> T | None:
        """Return what `look` returns as soon as that is not None; return None once discovery is complete without it."""
        return self._poll_until_discovered(look, _SURE_QUIET_S)

    def _poll_until_discovered(
        self,
        look: Callable[[], T | None],
        min_quiet_s: float,
        fingerprint: Callable[[], object] | None = None,
        *,
        named: bool = True,
    ) -> T | None:
        """Return what `look` returns as soon as that is not None, or its result once discovery is complete.

        Discovery is complete once all participants are known and `fingerprint` (default: the graph's) stays the same.
        `named`: the nodes' names must be known as well.
        """
        from tutor.ros.graph import graph_fingerprint

        get_fingerprint = fingerprint or partial(graph_fingerprint, self.node)
        start = changed = polled = time.monotonic()
        last_seen = get_fingerprint()
        slowest_step_s, starved_s = _POLL_S, 0.0
        while True:
            if (found := look()) is not None:
                return found
            now = time.monotonic()
            # While this process is starved of CPU, so are the DDS threads that receive the others' messages.
            starved_s += max(0.0, now - polled - 2 * _POLL_S)
            slowest_step_s, polled = max(slowest_step_s, now - polled), now
            if (latest := get_fingerprint()) != last_seen:
                slowest_step_s = max(slowest_step_s, now - changed)  # slow changes may be followed by more
                last_seen, changed = latest, now
            quiet_s = now - changed
            enough_s = max(min_quiet_s, min(2 * slowest_step_s, _SLOW_QUIET_S))
            if quiet_s >= enough_s and self._all_are_discovered(quiet_s, named):
                return look()
            if now - start - starved_s >= self.limit_s:
                return look()
            time.sleep(_POLL_S)

    def _all_are_discovered(self, quiet_s: float, named: bool) -> bool:
        discovered = self._discovered_participants()
        expected = participants_here(self.node.context.get_domain_id())
        if expected is None:
            return quiet_s >= _UNCOUNTED_QUIET_S
        if len(discovered) < expected:
            return False
        return not named or quiet_s >= _LONG_QUIET_S or self._all_nodes_have_names(discovered)

    def _discovered_participants(self) -> set[bytes]:
        """Return the ids of this machine's participants, ours included, whose endpoints have been discovered."""
        node = self.node
        asks = (node.get_publishers_info_by_topic, node.get_subscriptions_info_by_topic)
        senders, readers = ({_participant_id(info) for info in ask(_DISCOVERY_TOPIC, no_mangle=True)} for ask in asks)
        own = (
            _participant_id(info)
            for info in node.get_publishers_info_by_topic("/rosout")
            if info.node_name == node.get_name()
        )
        host = next((participant[:_HOST_BYTES] for participant in own), b"")
        return {participant for participant in senders & readers if participant.startswith(host)}

    def _all_nodes_have_names(self, participants: set[bytes]) -> bool:
        """Whether the node of each endpoint is known, and that of at least one endpoint of each participant.

        A participant lists its nodes in a message that may come after its first endpoints, and before the others.
        """
        endpoints = [
            info
            for topic, _ in self.node.get_topic_names_and_types()
            for ask in (self.node.get_publishers_info_by_topic, self.node.get_subscriptions_info_by_topic)
            for info in ask(topic)
        ]
        unknown = any(info.node_name == _UNKNOWN_NODE_NAME for info in endpoints)
        return not unknown and participants <= {_participant_id(info) for info in endpoints}


def _participant_id(info: Any) -> bytes:
    """Return the id of the participant that an endpoint belongs to."""
    return bytes(info.endpoint_gid[:12])
