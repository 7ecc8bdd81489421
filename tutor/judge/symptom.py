"""Symptoms: what a criterion saw go wrong, as data from which the catalogue of mistakes finds out why."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame


class Symptom(Enum):
    """The kinds of failures, as seen from outside; the value says it in words."""

    ENDED = "the program ended by itself, or made no node"
    NO_ANSWER = "the node is up and answers no request"
    NO_MESSAGES = "no message was published"
    NOTHING_RECEIVED = "what we published had no effect"
    MESSAGES_LOST = "only some of the messages that were published arrive, or may arrive"
    SHOWN_AGAIN = "a message that arrived once is shown more than once"
    SHOWN_TOGETHER = "messages that arrived one by one are shown in one log message"
    WRONG_VALUES = "the values published are wrong"
    WRONG_RATE = "messages come at another rate than asked for"
    CHANGE_IGNORED = "a parameter's value has no effect"
    NOT_DECLARED = "a parameter is missing, or has another type or default"
    REFUSED = "a good value of a parameter is refused"
    BAD_VALUE_ACCEPTED = "a bad value of a parameter is accepted"
    NOT_LOGGED = "something is missing from the log"
    WRONG_LOG = "the log says something that is not so"
    WRONG_LEVEL = "what happened is not logged at the level asked for"
    LOGGED_TOO_OFTEN = "the log says more often than it should what happened"
    SERVICE_MISSING = "a service is missing"
    ACTION_MISSING = "an action server is missing"
    WRONG_GOAL = "a goal of an action does not go as it should"
    WRONG_ANSWER = "a service's answer is wrong"
    CALLS_MISSING = "a client does not make its calls, or not all"
    RUNS_ON = "a program that should end by itself goes on"
    NOT_TOLD = "an action client does not say what becomes of its goal"
    WRONG_EXIT_CODE = "a program that should end with 0 ends with another exit code"
    STANDS_STILL = "a callback keeps others from running"
    CALLS_WAIT = "calls of a service made at once wait for each other"
    WRONG_STATE = "a lifecycle node does not make a transition as it should"
    NOT_SILENT = "a lifecycle node publishes in a state in which it should not"
    NOT_CLEANED_UP = "an unconfigured lifecycle node keeps what it made when it was, or should have been, configured"
    DOES_NOT_END = "the program does not end on Ctrl+C"
    ENDS_BADLY = "the program ends on Ctrl+C, but not cleanly"
    NOT_LAUNCHED = "a launch does not start what it should"
    WRONG_NAMES = "nodes or topics of a launch have other names than asked for"
    NOT_BUILT = "a package of message types is not built, or lacks one"
    OTHER_TYPES = "a message type has other fields than agreed on"
    NOT_CONNECTED = "nodes of a launch do not reach each other"
    SYSTEM_FAULT = "a system of several nodes does not do what it should"
    SYSTEM_CHANGED = "a system works, and is not as it was handed over"
    FAULT_NOT_NAMED = "the fault of a system is not reported, or another one is"

    def seen(
        self,
        trace: Trace,
        *,
        stuck: tuple[Frame, ...] = (),
        answers: bool = True,
        says: str = "",
        do: str = "",
        **about: Any,
    ) -> Observation:
        """An observation of this symptom in a run; see `Observation`."""
        return Observation(self, trace, tuple(stuck), answers, says, do, about)


@dataclass(frozen=True, slots=True)
class Observation:
    """One symptom, seen in one run.

    `stuck`: a stack dump of the node's threads while it answered nothing, innermost frame first. `answers`: whether the
    node has answered a request in this run. `says` and `do`: what the symptom itself says, and the next step, in words,
    where no mistake of the catalogue explains it. `about`: what else was seen, by name, such as `topic`, `type`,
    `parameter`, `service`, `wanted` and `found`; mistakes that need more than the run ask for it.
    """

    symptom: Symptom
    trace: Trace
    stuck: tuple[Frame, ...] = ()
    answers: bool = True
    says: str = ""
    do: str = ""
    about: Mapping[str, Any] = field(default_factory=dict)
