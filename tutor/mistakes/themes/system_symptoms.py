"""What each symptom of a system of several nodes says: as it looks from outside, and how to go on looking.

Nothing here says what is at fault: where a system is handed over, to find that out is the task.
"""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.mistakes.entry import Case, Found
from tutor.mistakes.symptom_entries import in_words, symptom


@symptom("system-at-fault", explains=[Symptom.SYSTEM_FAULT])
def system_at_fault(case: Case) -> Iterator[Found]:
    """A system of several nodes does not do what it should, and no node says why.

    Most faults between nodes are silent: no exception, no log message, just something that does not come. Do not read
    all of the code. Follow one message from where it begins, and find the last place where all is as it should be; the
    fault comes right after it. At each step, compare what runs with what was agreed on: nodes and their namespaces
    (`ros2 node list`), names and types of topics (`ros2 topic list -t`), both ends of a topic and their QoS
    (`ros2 topic info --verbose`), what is sent and how often (`ros2 topic echo`, `ros2 topic hz`), and parameters as
    the node has them, not as the file says (`ros2 param get`).

    Bad:

        # The door does not open: rewrite door.py, and see whether that helps.

    Good:

        # The door does not open.
        # ros2 topic hz /bell          the bell rings
        # ros2 topic info -v /bell     the door does not listen to it: look there, and only there

    See it: `ros2 topic info --verbose TOPIC`, for one topic after the other.
    """
    return in_words(
        case,
        "the system does not do what it should",
        "Follow one message from node to node, and compare what runs with what was agreed on.",
    )


@symptom("repair-changes-more", explains=[Symptom.SYSTEM_CHANGED])
def repair_changes_more(case: Case) -> Iterator[Found]:
    """A repair makes the system work, and leaves it different from what others rely on.

    Two ends of a topic can be made to match at either of them. Only one is wrong: the one that is not as it was agreed
    on. Change the other one, and everything here works, but the next node that relies on the agreement does not.

    Bad:

        # Agreed on: /bell is best effort. The door asked for reliable, and got nothing.
        # bell.py: create_publisher(Bool, '/bell', 10)

    Good:

        # Agreed on: /bell is best effort. The door asked for reliable, and got nothing.
        # door.py: create_subscription(Bool, '/bell', self.open, qos_profile_sensor_data)

    See it: `ros2 topic info --verbose TOPIC`, beside the agreement.
    """
    return in_words(
        case,
        "the system is not as it was handed over",
        "Undo what the repair does not need, and change the side that is not as it was agreed on.",
    )


@symptom("fault-not-reported", explains=[Symptom.FAULT_NOT_NAMED])
def fault_not_reported(case: Case) -> Iterator[Found]:
    """Nothing was reported yet on the fault of a system, or the report cannot be read.

    Before you repair a system, say what is wrong, and where. That keeps the repair small, and shows whether you have
    understood the fault or were lucky. The report has one of the given choices for each question.

    Bad:

        what:
        where:

    Good:

        what: qos
        where: door.py

    See it: the exercise's report, or `ros-tutor answer` with its id.
    """
    if not case.about("reported"):
        yield from in_words(case, "nothing is reported yet", "Find out what is wrong, and where; then report it.")


def _reported(source: str) -> Observation:
    return Symptom.FAULT_NOT_NAMED.seen(Trace("report.yaml", sources={"report.yaml": source}), reported=True)


@symptom("another-fault-reported", explains=[Symptom.FAULT_NOT_NAMED], example=_reported)
def another_fault_reported(case: Case) -> Iterator[Found]:
    """The report names a fault that the system does not have.

    A guess can be tested before it is reported: each fault has a sign that only it leaves. If that is missing, it is
    another one. No subscription at all on a topic cannot be the QoS; two ends that are both listed cannot be a name.

    Bad:

        # The door does not open, so its QoS must be wrong.

    Good:

        # The door does not open. If it is the QoS, ros2 topic info -v shows both ends, with other QoS.
        # It shows only the bell: so it is not the QoS. Is the door listening under another name?

    See it: `ros2 topic info --verbose TOPIC`, `ros2 node list`, `ros2 param get NODE PARAMETER`.
    """
    if case.about("reported"):
        yield from in_words(
            case,
            "this is not the fault of the system",
            "Ask yourself what else would be seen if it were so, and look for that.",
        )
