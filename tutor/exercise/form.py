"""What all forms have in common, and how an exercise becomes a check that the engine runs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields, replace
from typing import Any

from tutor.exercise.argument_types import reject_wrong_types
from tutor.exercise.node_parameters import ParameterNode
from tutor.exercise.nouns import LaunchFile, Parameter, Program
from tutor.judge.bench import Scenario
from tutor.judge.check import Check, Criterion, EarlyJudge, Judge
from tutor.judge.verdict import Verdict


@dataclass(frozen=True)
class Exercise:
    """What is started in an exercise, and its criteria, in the order in which they are shown."""

    started: Program | LaunchFile
    forms: tuple[Form, ...]

    @property
    def program(self) -> Program:
        """The program that is started. Raises ValueError for a launch file."""
        if isinstance(self.started, LaunchFile):
            raise ValueError(f"{self.started.file} is a LaunchFile: a criterion here needs a Program, which is started")
        return self.started

    @property
    def launch_file(self) -> LaunchFile:
        """The launch file. Raises ValueError for a program."""
        if not isinstance(self.started, LaunchFile):
            raise ValueError(
                f"{self.started.file} is a Program: a criterion here needs a LaunchFile, which is launched"
            )
        return self.started

    def first[F: Form](self, kind: type[F], suits: Callable[[F], bool] = lambda form: True) -> F | None:
        """The first criterion of this form for which `suits` is true."""
        return next((form for form in self.forms if isinstance(form, kind) and suits(form)), None)

    def scenario_of(self, form: Form | None) -> Scenario[Any] | None:
        """The scenario that a criterion is judged on first; None if the exercise has no such criterion."""
        return form.criterion(self).facts[0] if form is not None else None


@dataclass(frozen=True)
class Form(ABC):
    """An acceptance criterion of a recurring form.

    `id`: as in the lesson. `after`: the criteria that must pass first, since this one would only repeat their failure.
    `bonus`: it is judged and shown, and changes no verdict.
    """

    id: str
    after: Form | tuple[Form, ...] = field(default=(), kw_only=True)
    bonus: bool = field(default=False, kw_only=True)

    @property
    def starts_a_program(self) -> bool:
        """Whether its scenarios start a program, so that its facts take some time."""
        return True

    @property
    def used_parameters(self) -> tuple[Parameter, ...]:
        """The parameters that this criterion names."""
        return tuple(
            _parameters_in([getattr(self, attribute.name) for attribute in fields(self) if attribute.name != "after"])
        )

    @abstractmethod
    def criterion(self, exercise: Exercise) -> Criterion:
        """The criterion as the engine judges it: scenarios, which are values and run once if equal, and a judge."""

    def ended_start(self, exercise: Exercise) -> Scenario[Any] | None:
        """A start without parameters that this criterion alone is judged on, if it ends with Ctrl+C.

        Its facts have `trace` and `ending`; see `EndsCleanly`.
        """
        return None

    def judged(
        self,
        judge: Callable[..., Verdict],
        *scenarios: Scenario[Any] | None,
        early: EarlyJudge | None = None,
    ) -> Criterion:
        """The criterion that takes the facts of these scenarios; see `tutor.judge.check.Criterion`.

        `judge` gets None for a scenario that is None: that of another criterion, which the exercise does not have.
        `early`: the early judge of the first scenario's facts.
        """
        present = tuple(scenario for scenario in scenarios if scenario is not None)

        def judge_present(*facts: Any) -> Verdict:
            given = iter(facts)
            return judge(*(None if scenario is None else next(given) for scenario in scenarios))

        after = (self.after,) if isinstance(self.after, Form) else self.after
        return Criterion(
            self.id,
            judge if len(present) == len(scenarios) else judge_present,
            present,
            tuple(form.id for form in after),
            self.bonus,
            ((present[0], early),) if early is not None else (),
        )


@dataclass(frozen=True)
class Custom(Form):
    """A criterion with scenarios and a judge of its own, for what neither a form nor a function covers.

    `judge`: a pure function of the facts of `scenarios`, in their order. `early`: see `tutor.judge.check.Criterion`.
    """

    judge: Judge
    scenarios: tuple[Scenario[Any], ...]
    early: tuple[tuple[Scenario[Any], EarlyJudge], ...] = ()

    def criterion(self, exercise: Exercise) -> Criterion:
        return replace(self.judged(self.judge, *self.scenarios), early=self.early)


def _parameters_in(value: object) -> Iterator[Parameter]:
    if isinstance(value, Parameter):
        yield value
    elif isinstance(value, list | tuple | dict):
        for item in value:  # of a dict, its keys: parameters and the values that they are set to
            yield from _parameters_in(item)


def parameter_node(exercise: Exercise) -> ParameterNode:
    """The node with all parameters that the exercise names.

    Raises ValueError if none of them has an effect on a topic, by which its changes can be seen.
    """
    parameters = tuple(dict.fromkeys(parameter for form in exercise.forms for parameter in form.used_parameters))
    topics = [parameter.effect.topic for parameter in parameters if parameter.effect is not None]
    if not topics:
        raise ValueError("no parameter has an effect: give one ShownIn(topic), SetsRate(topic) or SwitchesOff(topic)")
    return ParameterNode(exercise.program, topics[0], parameters)


def check(
    exercise: str,
    started: Program | LaunchFile,
    *criteria: Form,
    expected_s: float = 0.0,
    expected_reason: str = "",
    mistakes: str = "",
) -> Check:
    """The check of an exercise, to be assigned to CHECK.

    `exercise`: its id, such as "i1.1". `started`: the learner's program or launch file. `expected_s`: the longest wait,
    in seconds, that a criterion needs with the solution, and `expected_reason` what it waits for. `mistakes`: the
    module with a catalogue of mistakes that only this exercise can know. Raises ValueError if an id is repeated, a
    criterion comes before one that it is `after`, it needs a program and a launch file is given, or the reverse, or an
    argument is of another type than the form takes.
    """
    if not isinstance(started, Program | LaunchFile):
        raise ValueError(f"{exercise}: what is started is a Program or a LaunchFile, not {started!r}")
    reject_wrong_types(started, type(started).__name__)
    for form in criteria:
        reject_wrong_types(form, form.id)
    context = Exercise(started, criteria)
    judged = tuple(form.criterion(context) for form in criteria)
    return Check(exercise, judged, expected_s, expected_reason, mistakes)
