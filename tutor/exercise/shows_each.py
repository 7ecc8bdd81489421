"""A form: the node logs each message of a publisher that is given, exactly once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tutor.exercise.form import Exercise, Form
from tutor.exercise.given_system import GivenPublisher, GivenSystem, Heard, SystemSeen
from tutor.exercise.receives import says
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import counted, output_tail
from tutor.ros_model import QoS, TopicEndpoint

_EXPECTED = {
    "before": "what was published on {topic} before the node started is in its log, once",
    "one by one": "each message on {topic} is in the log, once",
    "at once": "each of the messages sent at once on {topic} is in the log, once",
}


@dataclass(frozen=True)
class ShowsEach(Form):
    """The node logs each message of a publisher that is given, in one log message of its own, and never again.

    `publisher`: who sends, how and when; the publishers of all criteria of this form are there before the node starts,
    as in a system that it is added to. The subscription may ask for any QoS with which each message arrives. Where the
    publisher is reliable and does not send `one by one`, best effort is not enough, even if nothing happened to get
    lost: what was lost would never be sent again.

        ShowsEach("map", MAP)
    """

    publisher: GivenPublisher

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.ended_start(exercise))

    def ended_start(self, exercise: Exercise) -> GivenSystem:
        given = (form.publisher for form in exercise.forms if isinstance(form, ShowsEach))
        return GivenSystem(exercise.program, tuple(dict.fromkeys(given)))

    def judge(self, found: SystemSeen) -> Verdict:
        """Judge what became of the messages of this publisher."""
        topic = self.publisher.topic
        heard = next(part for part in found.heard if part.ours.topic == topic.name)
        requested = [endpoint for endpoint in found.trace.graph.subscriptions if endpoint.topic == topic.name]
        expected = _EXPECTED[self.publisher.sends].format(topic=topic.name)
        shown = [messages for messages in heard.shown if messages]
        evidence = list(_evidence(heard, requested, found))
        if together := _shown_together(heard):
            number = sum(len(messages) == 1 and messages[0] in together for messages in shown)
            observed = f"{number} of {counted(len(heard.sent), 'message')} in a log message with others"
            joined = found.symptom(Symptom.SHOWN_TOGETHER, topic=topic.name, type=topic.type, ours=heard.ours)
            return failed(expected, observed, joined, [*together[:3], *evidence])
        if len(shown) < len(heard.sent):
            observed, seen = self._missing(found, heard, len(shown))
            logged = [line for line in heard.last_logged if line not in evidence]
            return failed(expected, observed, seen, [*evidence, *logged] or output_tail(found.trace))
        if (twice := next((messages for messages in shown if len(messages) > 1), None)) is not None:
            many = sum(len(messages) > 1 for messages in shown)
            observed = f"{counted(many, 'message')} of {len(shown)} in more than one log message"
            again = found.symptom(Symptom.SHOWN_AGAIN, topic=topic.name, type=topic.type, ours=heard.ours)
            return failed(expected, observed, again, [*twice[:3], *evidence])
        if self._counts_on_each and requested and all(end.qos.reliability == "best_effort" for end in requested):
            observed = f"{counted(len(shown), 'message')} in the log, by luck: the subscription asks for best effort"
            lossy = found.symptom(Symptom.MESSAGES_LOST, topic=topic.name, type=topic.type, ours=heard.ours)
            return failed(expected, observed, lossy, evidence)
        return passed(expected, f"{counted(len(shown), 'message')}, each in one log message", shown[0])

    @property
    def _counts_on_each(self) -> bool:
        """Whether a message that is lost on its way has to be sent again."""
        return self.publisher.offers.reliability == "reliable" and self.publisher.sends != "one by one"

    def _missing(self, found: SystemSeen, heard: Heard, shown: int) -> tuple[str, Observation]:
        """What is observed where messages are missing from the log, and the symptom."""
        topic = self.publisher.topic
        about = {"topic": topic.name, "type": topic.type, "ours": heard.ours}
        first = next(value for value, messages in zip(heard.sent, heard.shown, strict=True) if not messages)
        observed = f"{topic.field}: {first} was published, and no log message has it"
        if shown and self.publisher.sends == "at once":
            observed = f"{len(heard.sent)} messages sent, {shown} in the log"
            newest = bool(heard.shown[-1])
            counts = {"sent": len(heard.sent), "shown": shown, "newest": newest}
            return observed, found.symptom(Symptom.MESSAGES_LOST, **about, **counts)
        if shown and heard.shown[-1]:
            observed = f"{len(heard.sent)} messages sent, one after the other, and {shown} in the log"
            return observed, found.symptom(Symptom.MESSAGES_LOST, **about, sent=len(heard.sent), shown=shown)
        if not self._may_have_reached(found, heard):
            return observed, found.symptom(Symptom.NOTHING_RECEIVED, **about, kept=self.publisher.sends == "before")
        unlogged = found.symptom(
            Symptom.NOT_LOGGED,
            **about,
            what=f"what arrives on {topic.name}",
            recognise=lambda text: says(text, first),
            at_end=found.ending.output if found.ending is not None else (),
            says=f"{first} was published on {topic.name}, and no log message of the node has it",
            do=f"Follow a message on {topic.name} through its callback to the node's logger.",
        )
        return observed, unlogged

    def _may_have_reached(self, found: SystemSeen, heard: Heard) -> bool:
        """Whether a subscription of the node was connected that also asks for what had been published before."""
        ends = [end.qos for end in found.trace.graph.subscriptions if end.topic == heard.ours.topic]
        wants_kept = any((end.reliability, end.durability) == ("reliable", "transient_local") for end in ends)
        return heard.matched and (self.publisher.sends != "before" or wants_kept or not ends)


def _shown_together(heard: Heard) -> list[str]:
    """The log messages that show several values, of which none is shown in another one.

    One that repeats a value that has been logged before is another mistake.
    """
    only = Counter(messages[0] for messages in heard.shown if len(messages) == 1)
    again = {message for messages in heard.shown if len(messages) > 1 for message in messages}
    return [message for message, number in only.items() if number > 1 and message not in again]


def _evidence(heard: Heard, requested: Iterable[TopicEndpoint], found: SystemSeen) -> Iterator[str]:
    """Both ends as `ros2 topic info -v` shows them, and what rclpy has warned of."""
    ends, topic = [*requested], heard.ours.topic
    names = (topic, topic.removeprefix("/"))  # rclpy names it as the node does
    if ends:
        yield f"offered on {topic}: {_in_words(heard.ours.qos)}"
    for end in ends:
        yield f"requested by {end.node}: {_in_words(end.qos)}"
    for record in found.trace.logs:
        if "incompatible QoS" in record.text and any(f"'{name}'" in record.text for name in names):
            yield str(record)


def _in_words(qos: QoS) -> str:
    return f"Reliability: {qos.reliability.upper()}, Durability: {qos.durability.upper()}"
