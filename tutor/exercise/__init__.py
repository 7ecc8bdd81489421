"""What an exercise is written in: the public interface for those who write one.

An exercise is one file that names what is started (a `Program` or a `LaunchFile`) and what its nodes have (`Topic`,
`Parameter`, `Service`), and declares a criterion for each line of the lesson's acceptance criteria, in one of the forms
below:

    GREETING = Topic("/greeting", "std_msgs/msg/String")

    greets = Publishes("greets", GREETING)

    CHECK = check(
        "h1.1",
        Program("greeter.py"),
        greets,
        Contains("says-hello", GREETING, "hello", after=greets),
        EndsCleanly("shutdown", bonus=True),
    )

How the program is started, how long is waited, and what the machine may be to blame for is the forms' business.
"""

from tutor.exercise.answers_at_once import AnswersAtOnce
from tutor.exercise.answers_by_asking import AnswersByAsking
from tutor.exercise.answers_without_reply import AnswersWithoutReply
from tutor.exercise.argument_moves import ArgumentMovesNamespace, ArgumentMovesTopic
from tutor.exercise.asking import Asking
from tutor.exercise.builds_interfaces import BuildsInterfaces
from tutor.exercise.calls_all import CallsAll
from tutor.exercise.criterion_function import criterion
from tutor.exercise.defaults import Defaults
from tutor.exercise.during_goal import DuringGoal
from tutor.exercise.ends_cleanly import EndsCleanly
from tutor.exercise.ends_while_asking import EndsWhileAsking
from tutor.exercise.error_words import SAYS_ERROR
from tutor.exercise.faults import Faults
from tutor.exercise.form import Custom, Form, check
from tutor.exercise.given_system import GivenPublisher
from tutor.exercise.handles_goal import HandlesGoal, SendsFeedback
from tutor.exercise.handles_two_goals import HandlesTwoGoals
from tutor.exercise.has_endpoints import Endpoint, HasEndpoints
from tutor.exercise.in_range import InRange, OtherUnit, Varies
from tutor.exercise.keeps_pace_while_asking import KeepsPaceWhileAsking
from tutor.exercise.keeps_rate import KeepsRate
from tutor.exercise.leads_to import LeadsTo
from tutor.exercise.lifecycle_forms import (
    Activates,
    BeginsUnconfigured,
    CleansUp,
    Configures,
    Deactivates,
    FailsToConfigure,
    ShutsDown,
)
from tutor.exercise.logs_at import LogsAt, StaysQuiet, Throttles
from tutor.exercise.logs_parameter import LogsParameter
from tutor.exercise.names_bad_value import NamesBadValue
from tutor.exercise.names_fault import NamesFault
from tutor.exercise.nouns import (
    Action,
    LaunchFile,
    Lifecycle,
    Parameter,
    Program,
    Service,
    SetsRate,
    ShownIn,
    SwitchesOff,
    Topic,
)
from tutor.exercise.pair_communicates import PairCommunicates
from tutor.exercise.publishes import AtLeast, Contains, FieldEquals, Publishes, ShownByEcho
from tutor.exercise.rate_at_run_time import RateAtRunTime
from tutor.exercise.rate_at_start import RateAtStart
from tutor.exercise.receives import Receives
from tutor.exercise.rejects import Rejects, RejectsAtomically
from tutor.exercise.running_node import Fields, Node
from tutor.exercise.sends_goal import HandlesRejection, SendsGoal
from tutor.exercise.serves import Answers, Serves
from tutor.exercise.service_calls import Question
from tutor.exercise.set_at_run_time import SetAtRunTime
from tutor.exercise.set_at_start import SetAtStart
from tutor.exercise.shows_each import ShowsEach
from tutor.exercise.stamped import Stamped
from tutor.exercise.starts_pair import StartsPair
from tutor.exercise.survives_bad_call import SurvivesBadCall
from tutor.exercise.tells import Tells
from tutor.exercise.told_events import Event, Feed
from tutor.exercise.watched_start import LogsText
from tutor.exercise.while_active import WhileActive
from tutor.judge.peers import GoalReplies
from tutor.ros_model import QoS

__all__ = [
    "SAYS_ERROR",
    "Action",
    "Activates",
    "Answers",
    "AnswersAtOnce",
    "AnswersByAsking",
    "AnswersWithoutReply",
    "ArgumentMovesNamespace",
    "ArgumentMovesTopic",
    "Asking",
    "AtLeast",
    "BeginsUnconfigured",
    "BuildsInterfaces",
    "CallsAll",
    "CleansUp",
    "Configures",
    "Contains",
    "Custom",
    "Deactivates",
    "Defaults",
    "DuringGoal",
    "Endpoint",
    "EndsCleanly",
    "EndsWhileAsking",
    "Event",
    "FailsToConfigure",
    "Faults",
    "Feed",
    "FieldEquals",
    "Fields",
    "Form",
    "GivenPublisher",
    "GoalReplies",
    "HandlesGoal",
    "HandlesRejection",
    "HandlesTwoGoals",
    "HasEndpoints",
    "InRange",
    "KeepsPaceWhileAsking",
    "KeepsRate",
    "LaunchFile",
    "LeadsTo",
    "Lifecycle",
    "LogsAt",
    "LogsParameter",
    "LogsText",
    "NamesBadValue",
    "NamesFault",
    "Node",
    "OtherUnit",
    "PairCommunicates",
    "Parameter",
    "Program",
    "Publishes",
    "QoS",
    "Question",
    "RateAtRunTime",
    "RateAtStart",
    "Receives",
    "Rejects",
    "RejectsAtomically",
    "SendsFeedback",
    "SendsGoal",
    "Serves",
    "Service",
    "SetAtRunTime",
    "SetAtStart",
    "SetsRate",
    "ShownByEcho",
    "ShownIn",
    "ShowsEach",
    "ShutsDown",
    "Stamped",
    "StartsPair",
    "StaysQuiet",
    "SurvivesBadCall",
    "SwitchesOff",
    "Tells",
    "Throttles",
    "Topic",
    "Varies",
    "WhileActive",
    "check",
    "criterion",
]
