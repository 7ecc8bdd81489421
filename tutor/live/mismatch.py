"""Why a publisher and a subscription of one topic do not match, in plain words. Pure."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from tutor.judge.qos import Policy, incompatible_policies
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
    for policy in incompatible_policies(publisher.qos, subscription.qos):
        yield _sentence(policy, publisher.qos, subscription.qos)


def _sentence(policy: Policy, offered: Qos, wanted: Qos) -> str:
    match policy:
        case "reliability":
            return (
                "Reliability: the publisher is best effort, the subscriber wants reliable. No message arrives: make "
                "the publisher reliable, or the subscriber best effort."
            )
        case "durability":
            return (
                "Durability: the publisher is volatile (keeps nothing for latecomers), the subscriber wants transient "
                "local. No message arrives: give both the same durability."
            )
        case "deadline":
            promise = "promises none" if offered.deadline_s is None else f"promises one every {offered.deadline_s:g} s"
            return (
                f"Deadline: the subscriber wants a message every {wanted.deadline_s:g} s, the publisher {promise}. "
                "No message arrives."
            )
        case "lease":
            return "Liveliness: the publisher's lease is longer than the subscriber allows. No message arrives."
        case "liveliness":
            return "Liveliness: the publisher's is automatic, the subscriber wants manual by topic. No message arrives."
