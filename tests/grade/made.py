"""A small class made in memory, with no check run: every kind of result, and names that try to break a format."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache

from tutor.content import Course, Lesson, load_course
from tutor.grade.gradebook import Gradebook
from tutor.grade.learners import Learner
from tutor.grade.points import Points
from tutor.grade.results import Result, Version
from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Lookup, Remark, Report
from tutor.judge.verdict import Status, Verdict, fault, passed, skipped

EXERCISES = ("i1.1", "i2.1")
ENVIRONMENT = Environment(ros_distro="jazzy", ros="bundled", rmw="rmw_fastrtps_cpp", ros_tutor="0.1.0")
FORMULA = "=cmd|' /C calc'!A0"
MARKUP = "<b>x</b><script>alert(1)</script>"
AWKWARD = 'O\'Neil, "Jo"\nZoë; \u202egnp.exe'
CONTROLS = "\x1b[31mred\x07 \x00nul\x85\tend"

ADA = Learner("ada", "Ada Lovelace", "101", "ada@example.org", {"SIS Login ID": "ada@example.org"})
BRIAN = Learner("brian", "Brian Gerkey", "102", "brian@example.org")
CHLOE = Learner("chloe", "Chloé d'Arc", "103", "chloe@example.org")
DEV = Learner("dev", "Dev Null", "104", "dev@example.org")
EVE = Learner("eve", FORMULA, "105", "eve@example.org")
MALLORY = Learner("mallory", MARKUP, "106", "mallory@example.org")
NEIL = Learner("neil", AWKWARD, "107", "neil@example.org")
OSCAR = Learner("oscar", CONTROLS, "108", "oscar@example.org")
LEARNERS = (ADA, BRIAN, CHLOE, DEV, EVE, MALLORY, NEIL, OSCAR)

STEP = "create the timer with 1.0 / rate"
RATE = Verdict(
    Status.FAILED,
    expected="2.0 Hz ±20 % with publish_rate:=2.0",
    observed="0.5 Hz over 5 samples",
    cause="rate used as a period: the timer fires every 2.0 s",
    step=STEP,
    evidence=("[INFO] [node]: a | b", '  File "my_node.py", line 3, in <module>'),
    mistake="rate-used-as-a-period",
    place="temperature_publisher.py:31",
)
FAULT = fault("no ROS domain id is free for a check on this machine", "close other checks")


@cache
def course() -> Course:
    """Return the bundled course."""
    return load_course()


def lesson(exercise: str = "i1.1") -> Lesson:
    """Return a lesson of the bundled course."""
    return course().find(exercise)


def passing(learner: Learner, exercise: str = "i1.1", *, bonus: bool = True) -> Result:
    """Everything passed, with a remark; without `bonus`, the bonus criteria failed."""
    verdicts = {
        each.id: passed("messages", "5 messages") if bonus or not each.bonus else RATE
        for each in lesson(exercise).criteria
    }
    remark = Remark("shutdown-after-ctrl-c", "line 61 raises RCLError", "temperature_publisher.py", 61)
    return _result(learner, _judged(exercise, verdicts, remarks=(remark,)))


def failing(learner: Learner, exercise: str = "i1.1", verdict: Verdict = RATE) -> Result:
    """The first criterion passed, the second failed with `verdict`, the third for the same reason, others skipped."""
    criteria = [each.id for each in lesson(exercise).criteria]
    same = replace(verdict, cause=f"for the same reason as `{criteria[1]}`", step="", same_as=criteria[1], evidence=())
    verdicts = {each: skipped(f"not judged, because `{criteria[1]}` did not pass") for each in criteria}
    verdicts |= {criteria[0]: passed("messages", "5 messages"), criteria[1]: verdict, criteria[2]: same}
    return _result(learner, _judged(exercise, verdicts))


def hostile(text: str) -> Verdict:
    """Return a failure in which the learner's program had its say: `text` is in all that is shown of it."""
    return replace(RATE, observed=text, cause=f"it printed {text}", step=f"do not print {text}", evidence=(text, text))


def missing(learner: Learner, exercise: str = "i1.1") -> Result:
    """Nothing was handed in."""
    verdict = Verdict(Status.SKIPPED, expected="temperature_publisher.py", cause="the exercise's file is not there")
    judged = _judged(exercise, {each.id: verdict for each in lesson(exercise).criteria})
    lookup = Lookup(("temperature_publisher.py",), ("homework (1).docx",))
    return _result(learner, replace(judged, submission=(), lookup=lookup, duration_s=0.0))


def unjudged(learner: Learner, exercise: str = "i1.1") -> Result:
    """A fault left the second criterion without a verdict; the first passed, the last failed."""
    criteria = [each.id for each in lesson(exercise).criteria]
    verdicts = {each: passed("messages", "5 messages") for each in criteria}
    return _result(learner, _judged(exercise, {**verdicts, criteria[1]: FAULT, criteria[-1]: RATE}), attempt=2)


def not_started(learner: Learner, exercise: str = "i1.1") -> Result:
    """A fault kept the check from starting: there are no criteria at all."""
    report = Report(ENVIRONMENT, (), 0.5, message="the check was silent for 120 s")
    return Result(learner, exercise, *_ORIGIN, report, cpu_s=0.1, attempt=2)


def gradebook(
    results: Iterable[Result] | None = None, *, points: Points | None = None, steps: bool = True
) -> Gradebook:
    """Return the gradebook of these results, by default of the whole class."""
    return Gradebook.of(
        whole_class() if results is None else results, course(), points or Points(), steps=steps, title="Robotics"
    )


def whole_class() -> Sequence[Result]:
    """Return the results of `LEARNERS`: two exercises each, but only one of Dev's has been graded."""
    return [
        *(passing(ADA, exercise) for exercise in EXERCISES),
        failing(BRIAN, "i1.1"),
        passing(BRIAN, "i2.1", bonus=False),
        missing(CHLOE, "i1.1"),
        unjudged(CHLOE, "i2.1"),
        not_started(DEV, "i1.1"),
        *(
            failing(learner, exercise, hostile(learner.name))
            for learner in (EVE, MALLORY, NEIL, OSCAR)
            for exercise in EXERCISES
        ),
    ]


_ORIGIN = ("2026-11-21T18:03:04+00:00", "0" * 64, Version("c" * 64, "0.1.0"))


def _judged(exercise: str, verdicts: dict[str, Verdict], remarks: tuple[Remark, ...] = ()) -> ExerciseResult:
    found = lesson(exercise)
    criteria = tuple(
        CriterionResult(each.id, each.text, each.bonus, verdicts[each.id], 1.23456) for each in found.criteria
    )
    files = tuple(file.name for file in found.files)
    return ExerciseResult(found.id, found.title, files, criteria, 3.98765, remarks=remarks)


def _result(learner: Learner, judged: ExerciseResult, attempt: int = 1) -> Result:
    report = Report(ENVIRONMENT, (judged,), 4.19876)
    return Result(learner, judged.id, *_ORIGIN, report, cpu_s=2.5, attempt=attempt)
