from __future__ import annotations

import pytest

from tutor.ros_model import QoS, QoSMismatch, Topic, TopicEndpoint, connections, echo_qos, incompatible_policies

STRING = "std_msgs/msg/String"


@pytest.mark.parametrize(
    ("offered", "requested"),
    [
        (QoS(), QoS()),
        (QoS(), QoS(reliability="best_effort")),
        (QoS(durability="transient_local"), QoS()),
        (QoS(deadline_s=0.1), QoS(deadline_s=0.5)),
        (QoS(liveliness="manual_by_topic"), QoS()),
        (QoS("system_default", "system_default"), QoS()),
    ],
)
def test_compatible_endpoints_have_no_mismatch(offered: QoS, requested: QoS) -> None:
    assert list(incompatible_policies(offered, requested)) == []


@pytest.mark.parametrize(
    ("offered", "requested", "mismatch"),
    [
        (QoS("best_effort"), QoS(), ("reliability", "best_effort", "reliable")),
        (QoS(), QoS(durability="transient_local"), ("durability", "volatile", "transient_local")),
        (QoS(), QoS(deadline_s=0.5), ("deadline", "infinite", "0.5 s")),
        (QoS(deadline_s=1.0), QoS(deadline_s=0.5), ("deadline", "1 s", "0.5 s")),
        (QoS(lease_s=2.0), QoS(lease_s=1.0), ("liveliness lease duration", "2 s", "1 s")),
        (QoS(), QoS(liveliness="manual_by_topic"), ("liveliness", "automatic", "manual_by_topic")),
    ],
)
def test_each_incompatible_policy_is_explained(offered: QoS, requested: QoS, mismatch: tuple[str, str, str]) -> None:
    assert list(incompatible_policies(offered, requested)) == [QoSMismatch(*mismatch)]


def test_a_connection_has_a_problem_for_each_incompatible_policy() -> None:
    publisher = TopicEndpoint("/t", STRING, "/a", QoS("best_effort"))
    subscription = TopicEndpoint("/t", STRING, "/b", QoS(durability="transient_local"))
    (pair,) = connections(Topic("/t", (publisher,), (subscription,)))
    assert [problem.partition(",")[0] for problem in pair.problems] == [
        "The publisher offers reliability best_effort",
        "The publisher offers durability volatile",
    ]
    assert pair.problems[0].endswith("Let the subscription ask for best_effort, or the publisher offer reliable.")


def test_with_different_types_only_the_types_are_reported() -> None:
    publisher = TopicEndpoint("/t", "std_msgs/msg/Float64", "/a", QoS("best_effort"))
    (pair,) = connections(Topic("/t", (publisher,), (TopicEndpoint("/t", STRING, "/b"),)))
    (problem,) = pair.problems
    assert "sends std_msgs/msg/Float64, the subscription expects std_msgs/msg/String" in problem


@pytest.mark.parametrize(
    ("offered", "chosen"),
    [
        ([], QoS("reliable", "volatile")),
        ([QoS("best_effort"), QoS()], QoS("best_effort", "volatile")),
        ([QoS(durability="transient_local"), QoS()], QoS("reliable", "volatile")),
        ([QoS("best_effort", "transient_local")], QoS("best_effort", "transient_local")),
    ],
)
def test_echo_requests_what_every_publisher_offers(offered: list[QoS], chosen: QoS) -> None:
    assert echo_qos(offered) == chosen
    assert not any(list(incompatible_policies(each, chosen)) for each in offered)
