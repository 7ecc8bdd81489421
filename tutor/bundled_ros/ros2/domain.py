"""Our node on the user's domain, and when it has seen all that is there.

There is no daemon that has watched the domain before. Fast DDS gives each participant (usually a process) UDP ports
of its own, so that those of this machine can be counted without asking; a list is complete when as many have been met.
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
"""The longest wait for participants whose ports are open, but which do not answer.

Where the answer to our announcement is lost, the next announcement of theirs comes within 3 s.
"""

_POLL_S = 0.01
_QUIET_S = 0.05  # what belongs together arrives within milliseconds
_SURE_QUIET_S = 0.2  # before it is said that something is not there
_LONG_QUIET_S = 1.5  # a DDS program that is not a ROS node never gets a node's name
_UNCOUNTED_QUIET_S = 0.5  # where it cannot be known how many there are
_SLOW_QUIET_S = 1.0  # the longest, where all comes slowly
_UNKNOWN = "_NODE_NAME_UNKNOWN_"
_HOST = 4  # this many bytes of a participant's id are those of its machine
_BOOKKEEPING = "ros_discovery_info"  # the DDS topic on which each participant says which nodes it has


def add_direct_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of each verb that joins the domain."""
    parser.add_argument(
        "--spin-time",
        type=float,
        help=f"the longest wait for others to be found, in seconds (default: {LIMIT_S:g}; it usually takes far less)",
    )
    parser.add_argument("-s", "--use-sim-time", action="store_true", help="use the time of a simulation (/clock)")


def add_strategy_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of each verb for which ros2cli would ask its daemon."""
    add_direct_arguments(parser)
    parser.add_argument("--no-daemon", action="store_true", help="always so here: there is no daemon")


@contextmanager
def join_domain(arguments: argparse.Namespace, *, name: str | None = None) -> Iterator[Domain]:
    """Join the domain with a node, for as long as the block lasts.

    The node is hidden, as those of ros2cli are, unless it is given a name. Nothing spins it: a verb that has
    subscriptions, timers or clients does. Raises CommandError where ROS cannot be joined.
    """
    import rclpy
    from rclpy.exceptions import InvalidNodeNameException
    from rclpy.parameter import Parameter

    from tutor.ros.participant import new_context

    # Python's own handler raises KeyboardInterrupt; rclpy's would end the context under whatever is going on.
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
    """The domain as `node` sees it. `limit_s` bounds each wait for what is there to be seen."""

    node: Node
    limit_s: float = LIMIT_S

    def complete(self) -> None:
        """Wait until everything that is on the domain has been seen."""
        self._until(lambda: None, _QUIET_S)

    def complete_publishers(self, topic: str) -> list[TopicEndpointInfo]:
        """The publishers of a topic, as soon as all have been seen. Their nodes' names may still be unknown."""
        ask = self.node.get_publishers_info_by_topic
        self._until(lambda: None, _QUIET_S, lambda: (sorted(self._participants()), len(ask(topic))), named=False)
        return list(ask(topic))

    def find(self, look: Callable[[], T | None]) -> T | None:
        """What `look` gives, as soon as it is not None; None where it is not there, which all has been seen for."""
        return self._until(look, _SURE_QUIET_S)

    def _until(
        self,
        look: Callable[[], T | None],
        least_quiet_s: float,
        fingerprint: Callable[[], object] | None = None,
        *,
        named: bool = True,
    ) -> T | None:
        """What `look` gives, or gives at last once `fingerprint` (else that of the graph) has kept still."""
        from tutor.ros.graph import graph_fingerprint

        sight = fingerprint or partial(graph_fingerprint, self.node)
        start = changed = polled = time.monotonic()
        seen = sight()
        slowest_s, late_s = _POLL_S, 0.0
        while True:
            if (found := look()) is not None:
                return found
            now = time.monotonic()
            # Where we are kept from running, so are our threads that the others talk to.
            late_s += max(0.0, now - polled - 2 * _POLL_S)
            slowest_s, polled = max(slowest_s, now - polled), now
            if (sees := sight()) != seen:
                slowest_s = max(slowest_s, now - changed)  # what comes slowly may have more to come
                seen, changed = sees, now
            quiet_s = now - changed
            if quiet_s >= max(least_quiet_s, min(2 * slowest_s, _SLOW_QUIET_S)) and self._all_are_met(quiet_s, named):
                return look()
            if now - start - late_s >= self.limit_s:
                return look()
            time.sleep(_POLL_S)

    def _all_are_met(self, quiet_s: float, named: bool) -> bool:
        met = self._participants()
        expected = participants_here(self.node.context.get_domain_id())
        if expected is None:
            return quiet_s >= _UNCOUNTED_QUIET_S
        if len(met) < expected:
            return False
        return not named or quiet_s >= _LONG_QUIET_S or self._all_have_names()

    def _participants(self) -> set[bytes]:
        """Those of this machine, ourselves included, of which something that they publish and subscribe to is known."""
        node = self.node
        asks = (node.get_publishers_info_by_topic, node.get_subscriptions_info_by_topic)
        senders, readers = ({_id(info) for info in ask(_BOOKKEEPING, no_mangle=True)} for ask in asks)
        own = (_id(info) for info in node.get_publishers_info_by_topic("/rosout") if info.node_name == node.get_name())
        host = next((each[:_HOST] for each in own), b"")
        return {each for each in senders & readers if each.startswith(host)}

    def _all_have_names(self) -> bool:
        return not any(
            info.node_name == _UNKNOWN
            for topic, _ in self.node.get_topic_names_and_types()
            for ask in (self.node.get_publishers_info_by_topic, self.node.get_subscriptions_info_by_topic)
            for info in ask(topic)
        )


def _id(info: Any) -> bytes:
    """The id of the participant that an endpoint belongs to."""
    return bytes(info.endpoint_gid[:12])
