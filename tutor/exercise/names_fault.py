"""A form: the learner has found the fault of a system that was handed over, and reports what it is, and where."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import yaml

from tutor.exercise.faults import Fault, Faults
from tutor.exercise.form import Exercise, Form
from tutor.exercise.publishing_start import NOT_STARTED
from tutor.judge.bench import Bench
from tutor.judge.check import Criterion
from tutor.judge.symptom import Symptom
from tutor.judge.verdict import Verdict, failed, passed

EXPECTED = "the report says what is wrong, and in which file"


@dataclass(frozen=True)
class ReadReport:
    """Read the learner's report; nothing is started."""

    file: str

    async def __call__(self, bench: Bench) -> str:
        return bench.read(self.file)


@dataclass(frozen=True)
class NamesFault(Form):
    """The learner's report names the fault of the case that was handed over: what it is, and in which file.

    The report is a file of the submission with the keys `case`, `what` and `where`, and as `tries` how many answers
    were given; `ros-tutor answer` writes it. If it is written by hand, the kind may have capitals (`QoS`), and the file
    its folder. After a wrong one, the learner is told whether the file or the kind is right, and how the fault that it
    names would show, so that the next one is no guess. `faults`: all cases, and the choices.

        NamesFault("found", Faults.read(Path(__file__).parents[1] / "lessons/x1_4/cases.yaml"))
    """

    faults: Faults

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, ReadReport(self.faults.report))

    def judge(self, text: str) -> Verdict:
        """Judge the text of a report."""
        file = self.faults.report
        report = _fields(text)
        if report is None:
            says, do = f"{file} is not YAML any more", "Write `what: ` and `where: `, each with one of the choices."
            return self._failed("it cannot be read", says, do)
        case, what, where = (_word(report.get(key)) for key in ("case", "what", "where"))
        fault = self.faults.cases.get(case)
        if fault is None:
            says, do = (
                f"{file} does not say which case it is",
                "Put back its line `case:`, or start the exercise again.",
            )
            return self._failed(f"case: {case}", says, do)
        do = "Watch the system until you know what it is, and where: then answer."
        if not what and not where:
            return self._failed("no answer yet", f"nothing is reported yet in {file}", do)
        if not what or not where:
            says = f"`{'where' if what else 'what'}` is not reported yet in {file}"
            return self._failed("half an answer", says, do)
        return self._judge_answer(fault, what, where, report.get("tries"))

    def _judge_answer(self, fault: Fault, what: str, where: str, tries: object) -> Verdict:
        files, kinds = sorted({case.where for case in self.faults.cases.values()}), self.faults.kinds
        what = next((kind for kind in kinds if kind.casefold() == what.casefold()), what)
        where = next((file for file in files if file == where.rpartition("/")[2]), where)
        for key, value, choices in (("what", what, list(kinds)), ("where", where, files)):
            if value not in choices:
                do = f"Choose one of {', '.join(choices)}."
                return self._failed(f"{key}: {value}", f"{value!r} is none of the choices for `{key}`", do)
        number = f", answer {tries}" if isinstance(tries, int) and tries > 1 else ""
        answer = f"{kinds[what].says}, in {where}{number}"
        if where == fault.where and what in fault.what:
            return passed(EXPECTED, answer)
        shows = f"If it were so: {kinds[what].shows[0].lower()}{kinds[what].shows[1:]}" if kinds[what].shows else ""
        if where == fault.where:
            return self._failed(answer, "the file is right, but something else is wrong in it", shows)
        if what in fault.what:
            do = "Which side differs from what was agreed? Compare each of them with the hand-over note."
            return self._failed(answer, "this kind of fault is right, but it is in another file", do)
        return self._failed(answer, "this is not the fault of the system that you were given", shows)

    def _failed(self, observed: str, says: str, do: str) -> Verdict:
        reported = observed.startswith(tuple(kind.says for kind in self.faults.kinds.values()))
        seen = Symptom.FAULT_NOT_NAMED.seen(NOT_STARTED, says=says, do=do, reported=reported)
        return failed(EXPECTED, observed, seen)


def _fields(text: str) -> dict[str, Any] | None:
    """The fields of a report; None if it is not YAML with fields."""
    try:
        found = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError):  # a date that does not exist; brackets without end
        return None
    return found if isinstance(found, dict) else {} if found is None else None


def _word(value: object) -> str:
    """A field as a word. A list or the like is none: it may hold itself, or be endless when it is written out."""
    return str(value) if isinstance(value, str | int | float) else "" if value is None else "(a list)"
