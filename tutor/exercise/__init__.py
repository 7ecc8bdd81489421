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

from tutor.exercise.argument_moves import ArgumentMovesNamespace, ArgumentMovesTopic
from tutor.exercise.calls_all import CallsAll
from tutor.exercise.criterion_function import criterion
from tutor.exercise.defaults import Defaults
from tutor.exercise.ends_cleanly import EndsCleanly
from tutor.exercise.error_words import SAYS_ERROR
from tutor.exercise.form import Custom, Form, check
from tutor.exercise.handles_goal import HandlesGoal
from tutor.exercise.in_range import InRange, OtherUnit, Varies
from tutor.exercise.lifecycle_forms import (
    Activates,
    BeginsUnconfigured,
    CleansUp,
    Configures,
    Deactivates,
    FailsToConfigure,
    ShutsDown,
)
from tutor.exercise.logs_parameter import LogsParameter
from tutor.exercise.names_bad_value import NamesBadValue
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
from tutor.exercise.serves import Answers, Serves
from tutor.exercise.service_calls import Question
from tutor.exercise.set_at_run_time import SetAtRunTime
from tutor.exercise.set_at_start import SetAtStart
from tutor.exercise.starts_pair import StartsPair
from tutor.exercise.survives_bad_call import SurvivesBadCall
from tutor.exercise.watched_start import LogsText

__all__ = [
    "SAYS_ERROR",
    "Action",
    "Activates",
    "Answers",
    "ArgumentMovesNamespace",
    "ArgumentMovesTopic",
    "AtLeast",
    "BeginsUnconfigured",
    "CallsAll",
    "CleansUp",
    "Configures",
    "Contains",
    "Custom",
    "Deactivates",
    "Defaults",
    "EndsCleanly",
    "FailsToConfigure",
    "FieldEquals",
    "Fields",
    "Form",
    "HandlesGoal",
    "InRange",
    "LaunchFile",
    "Lifecycle",
    "LogsParameter",
    "LogsText",
    "NamesBadValue",
    "Node",
    "OtherUnit",
    "PairCommunicates",
    "Parameter",
    "Program",
    "Publishes",
    "Question",
    "RateAtRunTime",
    "RateAtStart",
    "Receives",
    "Rejects",
    "RejectsAtomically",
    "Serves",
    "Service",
    "SetAtRunTime",
    "SetAtStart",
    "SetsRate",
    "ShownByEcho",
    "ShownIn",
    "ShutsDown",
    "StartsPair",
    "SurvivesBadCall",
    "SwitchesOff",
    "Topic",
    "Varies",
    "check",
    "criterion",
]
