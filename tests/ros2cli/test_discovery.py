"""When discovery counts as complete, with a made-up graph."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from tutor.bundled_ros.ros2.domain import Domain

OURS, THEIRS = bytes(12), bytes(11) + b"\x01"
UNKNOWN = "_NODE_NAME_UNKNOWN_"


class FakeNode:
    """A node that has discovered these endpoints, each given as (topic, participant, name of its node)."""

    def __init__(self, *endpoints: tuple[str, bytes, str]) -> None:
        self._endpoints = endpoints

    def get_topic_names_and_types(self) -> list[tuple[str, list[str]]]:
        return [(topic, []) for topic in sorted({topic for topic, _, _ in self._endpoints})]

    def get_publishers_info_by_topic(self, topic: str) -> list[Any]:
        found = [each for each in self._endpoints if each[0] == topic]
        return [SimpleNamespace(endpoint_gid=participant + bytes(4), node_name=name) for _, participant, name in found]

    def get_subscriptions_info_by_topic(self, topic: str) -> list[Any]:
        return []


@pytest.mark.parametrize(
    ("endpoints", "complete"),
    [
        ([("/rosout", OURS, "us"), ("/rosout", THEIRS, "talker")], True),
        ([("/rosout", OURS, "us"), ("/rosout", THEIRS, UNKNOWN)], False),
        ([("/rosout", OURS, "us"), ("/rosout", THEIRS, "talker"), ("/chatter", THEIRS, UNKNOWN)], False),
        ([("/rosout", OURS, "us")], False),  # it has been discovered, but nothing of its nodes
    ],
)
def test_names_are_complete_once_each_participant_has_told_its_nodes(
    endpoints: list[tuple[str, bytes, str]], complete: bool
) -> None:
    domain = Domain(FakeNode(*endpoints))  # type: ignore[arg-type]
    assert domain._all_nodes_have_names({OURS, THEIRS}) is complete
