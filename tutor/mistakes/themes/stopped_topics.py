"""Topics on which messages stop coming, or cannot be shown since they have two types."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run


@mistake(
    "another-type-on-the-topic",
    name="wrong type",
    explains=[Symptom.NO_MESSAGES],
    evidence=Evidence.RUN,
    says="{topic} carries two types, {types}: a tool that takes the type from the topic cannot choose",
    do="Give everything on this topic the type that is asked for.",
    example=in_run(Symptom.NO_MESSAGES, topic="/ring", types=("std_msgs/msg/Bool", "std_msgs/msg/String")),
)
def two_types(case: Case) -> Iterator[Found]:
    """Two types are on one topic.

    Publishers and subscriptions of two types never meet, even if the name is the same, and `ros2 topic echo` refuses to
    choose.

    Bad:

        self.create_publisher(Bool, 'ring', 10)
        self.create_publisher(String, 'ring', 10)

    Good:

        self.create_publisher(Bool, 'ring', 10)

    See it: `ros2 topic list -t`.
    """
    types = case.about("types", ())
    if len(types) > 1:
        yield Found({"topic": case.about("topic"), "types": " and ".join(types)})


@mistake(
    "stops-publishing",
    name="no messages",
    explains=[Symptom.NO_MESSAGES],
    evidence=Evidence.SYMPTOM,
    says="{what}",
    do="Let a timer publish for as long as the node lives, with a QoS that keeps a message until it is read.",
    example=in_run(Symptom.NO_MESSAGES, some=True),
)
def stops(case: Case) -> Iterator[Found]:
    """A node stops publishing.

    One message from __init__, or a few, are gone before anybody listens. What should be there for whoever comes later
    has to be sent again and again.

    Bad:

        def __init__(self):
            self.ring_once()

    Good:

        def __init__(self):
            self.create_timer(1.0, self.ring_once)

    See it: `ros2 topic hz TOPIC`.
    """
    if case.about("gone"):
        yield Found({"what": "the publisher was gone when a new subscriber looked for it"})
    elif case.about("qos"):
        yield Found({"what": f"a new subscriber got nothing ({case.about('qos')})"})
    elif case.about("some"):
        yield Found({"what": "the node stops publishing, or publishes far too rarely"})
