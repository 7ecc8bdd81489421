"""A form: in a launch, a subscriber gets what a publisher sends."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.exercise.form import Exercise, Form
from tutor.exercise.launch_graph import Pair, describe_pair, pairs
from tutor.exercise.launch_run import Launch, LaunchRun
from tutor.exercise.launch_symptoms import seen_in_launch
from tutor.exercise.quoted_messages import logs_of_messages
from tutor.judge.check import Criterion
from tutor.judge.launch_output import ended_processes
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import counted, output_tail
from tutor.ros_model import incompatible_policies


@dataclass(frozen=True)
class PairCommunicates(Form):
    """In a launch without arguments, a subscriber gets what a publisher of another node sends.

    One such pair is enough, on any topic: type and QoS fit, messages are sent, and the subscriber logs them or still
    answers a request. The exercise's program must be a `LaunchFile`:

        PairCommunicates("communicates", after=starts)
    """

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, self.ended_start(exercise))

    def ended_start(self, exercise: Exercise) -> Launch:
        return Launch(exercise.launch_file)

    def judge(self, seen: LaunchRun) -> Verdict:
        """Judge a launch without arguments."""
        expected = "without arguments, the subscriber gets what the publisher sends"
        found = pairs(seen.trace.graph)
        if not found:
            apart = seen_in_launch(Symptom.NOT_CONNECTED, seen)
            return failed(expected, seen.describe(), apart, output_tail(seen.trace))
        reasons: list[Observation] = []
        for pair in found:
            reason = _undelivered(seen, pair)
            if reason is None:
                topic = pair[0].topic
                count = len(seen.trace.samples_on(topic))
                logs = logs_of_messages(pair, seen.trace.logs, seen.trace.samples_on(topic))
                observed = f"{counted(count, 'message')} on {topic}" if count else f"connected on {topic}"
                return passed(expected, observed, [*describe_pair(pair), *(str(log) for log in logs[:2])])
            reasons.append(reason)
        return failed(expected, seen.describe(), reasons[0], output_tail(seen.trace))


def _undelivered(seen: LaunchRun, pair: Pair) -> Observation | None:
    """What is seen of messages of this pair that do not arrive; None where they do."""
    publisher, subscription = pair
    if publisher.type != subscription.type:
        return seen_in_launch(
            Symptom.NOT_CONNECTED,
            seen,
            says=f"on {publisher.topic}, {publisher.node} sends {publisher.type}, and {subscription.node} wants "
            f"{subscription.type}",
            do="Choose two programs whose messages have the same type.",
        )
    if any(incompatible_policies(publisher.qos, subscription.qos)):
        return seen_in_launch(Symptom.NOT_CONNECTED, seen, topic=publisher.topic)
    if not seen.trace.samples_on(publisher.topic) and publisher.topic not in seen.hidden:
        return seen_in_launch(
            Symptom.NOT_CONNECTED,
            seen,
            says=f"{publisher.node} publishes nothing on {publisher.topic}",
            do="Start it alone, and look at its output.",
            silent=publisher.node,
        )
    alive = subscription.node in seen.answering
    mute = subscription.node not in seen.trace.graph.parameter_nodes
    logged = logs_of_messages(pair, seen.trace.logs, seen.trace.samples_on(publisher.topic))
    if seen.disconnected:
        return seen_in_launch(
            Symptom.NOT_CONNECTED,
            seen,
            says=f"{publisher.node} and {subscription.node} were connected, but one of them is gone",
            do="See in the last lines of the output which program has ended, and why.",
        )
    if alive or (mute and seen.trace.exit is None) or (logged and not ended_processes(seen.trace.output)):
        return None
    return seen_in_launch(
        Symptom.NOT_CONNECTED,
        seen,
        says=f"{subscription.node} has a subscription, but answers no request: its callbacks are never run",
        do="Let the program spin its node, and let no callback block.",
    )
