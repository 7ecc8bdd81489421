"""The names of the causes listed in the contract: learners look them up and share them, so they never change.

A submission in the tests proves each one; `tests/judge/test_names.py` keeps the list and the submissions consistent.
"""

from __future__ import annotations

from collections.abc import Mapping

WRONG_TOPIC = "wrong topic"
WRONG_TYPE = "wrong type"
INCOMPATIBLE_QOS = "incompatible QoS"
NO_SPIN = "no spin"
EXIT_AT_ONCE = "exit at once"
SYNTAX_ERROR = "syntax error"
IMPORT_ERROR = "import error"
UNHANDLED_EXCEPTION = "unhandled exception"
INTEGER_PARAMETER = "integer parameter"
CALLBACK_RETURNS_NONE = "callback returns None"
TIMER_NOT_REPLACED = "timer not replaced"
OLD_TIMER_KEPT = "old timer kept"
RATE_AS_PERIOD = "rate used as a period"
BLOCKED_EXECUTOR = "blocked executor"
DEADLOCK = "deadlock by call()"
FLOAT_IN_INT = "float in an int field"
HELD_BACK = "output held back by buffering"
SIGINT_IGNORED = "SIGINT ignored"
SAME_NAME = "second node of the same name"

MEANINGS: Mapping[str, str] = {
    WRONG_TOPIC: "a near-miss name, a slash too many or too few, a namespace",
    WRONG_TYPE: "the right topic or service with another type",
    INCOMPATIBLE_QOS: "publisher and subscription do not match, so that nothing is delivered",
    NO_SPIN: "the node is there, but nobody runs its callbacks",
    EXIT_AT_ONCE: "the program ends instead of waiting for work",
    SYNTAX_ERROR: "Python cannot read the file",
    IMPORT_ERROR: "a module, or a name in it, is not there",
    UNHANDLED_EXCEPTION: "an exception that nothing catches, with the learner's own line",
    INTEGER_PARAMETER: "declared with a whole number where a decimal one is given",
    CALLBACK_RETURNS_NONE: "a parameter callback without a SetParametersResult",
    TIMER_NOT_REPLACED: "a new rate is accepted, the timer keeps the old one",
    OLD_TIMER_KEPT: "a new timer is made beside the old one",
    RATE_AS_PERIOD: "Hz are given to a timer that takes seconds",
    BLOCKED_EXECUTOR: "a callback that never returns",
    DEADLOCK: "a callback waits for an answer that only its own executor could take in",
    FLOAT_IN_INT: "the result of / in a field for whole numbers",
    HELD_BACK: "print() into a pipe waits for a full buffer",
    SIGINT_IGNORED: "Ctrl+C does not end the program",
    SAME_NAME: "two nodes under one name, both at work",
}
"""The meaning of each name."""
