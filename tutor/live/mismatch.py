"""Why a publisher and a subscription of one topic do not match, in plain words. Pure."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from tutor.live.facts import Endpoint, Qos, Topic


@dataclass(frozen=True, slots=True)
class Connection:
    """A publisher and a subscription of one topic; `problems` say why no message gets from one to the other."""

    topic: str
    publisher: Endpoint
    subscription: Endpoint
    problems: tuple[str, ...]


def connections(topic: Topic) -> Iterator[Connection]:
    """Every pair of one topic."""
    for publisher in topic.publishers:
        for subscription in topic.subscriptions:
            yield Connection(topic.name, publisher, subscription, tuple(problems(publisher, subscription)))


def problems(publisher: Endpoint, subscription: Endpoint) -> Iterator[str]:
    """Each reason why these two do not match, as a whole sentence."""
    if publisher.type != subscription.type:
        yield (
            f"The types differ: the publisher sends {publisher.type}, the subscriber expects {subscription.type}. "
            "No message arrives."
        )
        return
    yield from _qos(publisher.qos, subscription.qos)


def _qos(offered: Qos, wanted: Qos) -> Iterator[str]:
    if offered.reliability == "best_effort" and wanted.reliability == "reliable":
        yield (
            "Reliability: the publisher is best effort, the subscriber wants reliable. No message arrives: make the "
            "publisher reliable, or the subscriber best effort."
        )
    if offered.durability == "volatile" and wanted.durability == "transient_local":
        yield (
            "Durability: the publisher is volatile (keeps nothing for latecomers), the subscriber wants transient "
            "local. No message arrives: give both the same durability."
        )
    if wanted.deadline_s is not None and (offered.deadline_s is None or offered.deadline_s > wanted.deadline_s):
        promise = "promises none" if offered.deadline_s is None else f"promises one every {offered.deadline_s:g} s"
        yield (
            f"Deadline: the subscriber wants a message every {wanted.deadline_s:g} s, the publisher {promise}. "
            "No message arrives."
        )
    if wanted.lease_s is not None and (offered.lease_s is None or offered.lease_s > wanted.lease_s):
        yield "Liveliness: the publisher's lease is longer than the subscriber allows. No message arrives."
    if (offered.liveliness, wanted.liveliness) == ("automatic", "manual_by_topic"):
        yield "Liveliness: the publisher's is automatic, the subscriber wants manual by topic. No message arrives."
