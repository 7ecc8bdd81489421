"""H1.1 Greeter: a text on /greeting."""

from __future__ import annotations

from checks.h1_1 import scenarios
from tutor.judge.check import Check, Criterion

from . import judges

CHECK = Check(
    "h1.1", (Criterion("greets", judges.judge_greets, (scenarios.first_greeting,)),), mistakes="checks.h1_1.mistakes"
)
