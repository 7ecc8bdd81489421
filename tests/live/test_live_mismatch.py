from __future__ import annotations

from itertools import pairwise

import pytest

from tutor.live.facts import Endpoint, Qos, Topic
from tutor.live.mismatch import connections, problems

STRING = "std_msgs/msg/String"


def found(offered: Qos, wanted: Qos) -> list[str]:
    return list(problems(Endpoint("/a", STRING, offered), Endpoint("/b", STRING, wanted)))


def test_what_matches_has_no_problem() -> None:
    assert found(Qos(), Qos()) == []
    assert found(Qos(), Qos(reliability="best_effort")) == []
    assert found(Qos(durability="transient_local"), Qos()) == []
    assert found(Qos(deadline_s=0.1), Qos(deadline_s=0.5)) == []
    assert found(Qos(liveliness="manual_by_topic"), Qos()) == []


@pytest.mark.parametrize(
    ("offered", "wanted", "words"),
    [
        (Qos(reliability="best_effort"), Qos(), "publisher is best effort, the subscriber wants reliable"),
        (Qos(), Qos(durability="transient_local"), "the subscriber wants transient local"),
        (Qos(), Qos(deadline_s=0.5), "every 0.5 s, the publisher promises none"),
        (Qos(deadline_s=1.0), Qos(deadline_s=0.5), "the publisher promises one every 1 s"),
        (Qos(lease_s=2.0), Qos(lease_s=1.0), "lease is longer"),
        (Qos(), Qos(liveliness="manual_by_topic"), "wants manual by topic"),
    ],
)
def test_what_does_not_match_is_explained(offered: Qos, wanted: Qos, words: str) -> None:
    (said,) = found(offered, wanted)
    assert words in said
    assert "No message arrives" in said


def test_two_reasons_are_two_sentences() -> None:
    said = found(Qos(reliability="best_effort"), Qos(durability="transient_local"))
    assert len(said) == 2
    assert all(a.partition(":")[0] != b.partition(":")[0] for a, b in pairwise(said))


def test_of_different_types_only_that_is_said() -> None:
    publisher = Endpoint("/a", "std_msgs/msg/Float64", Qos(reliability="best_effort"))
    (pair,) = connections(Topic("/t", (publisher,), (Endpoint("/b", STRING),)))
    (said,) = pair.problems
    assert "sends std_msgs/msg/Float64, the subscriber expects std_msgs/msg/String" in said
