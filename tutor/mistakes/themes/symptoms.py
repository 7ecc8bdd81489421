"""What each symptom says where no mistake of the catalogue explains it: what to look at next, and how."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, mistake


def _own_words(case: Case, says: str, do: str) -> Iterator[Found]:
    """The criterion's own words, or else these."""
    yield Found({"says": case.seen.says or says, "do": case.seen.do or do})


@mistake("no-messages", explains=[Symptom.NO_MESSAGES], evidence=Evidence.SYMPTOM, says="{says}", do="{do}")
def no_messages(case: Case) -> Iterator[Found]:
    """Nothing arrives on a topic.

    A message is on its way only while publish() is called, and a node calls it from a callback: most often a timer's. A
    publisher that exists is not enough, and neither is a method that nothing calls.

    Bad:

        self.horn = self.create_publisher(Bool, 'horn', 10)

    Good:

        self.horn = self.create_publisher(Bool, 'horn', 10)
        self.timer = self.create_timer(2.0, self.sound_the_horn)

    See it: `ros2 topic info -v TOPIC` shows who publishes and who listens; `ros2 topic hz TOPIC` what arrives.
    """
    topic = case.about("topic", "the topic")
    return _own_words(
        case,
        f"{case.nodes} sends nothing on {topic}",
        "Publish from a callback that runs again and again, and see in Live what it sends.",
    )
