"""Forms as another exercise uses them: a thermostat, whose author has less to ask than our exercises."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from tests.checks.builders import (
    NO_NODE,
    answer,
    assert_failed,
    assert_passed,
    assert_skipped,
    called,
    early_judge_of,
    ending,
    graph,
    judge_of,
    log,
    parameter,
    refused,
    sample,
    samples,
    trace,
)
from tutor.exercise import (
    Answers,
    BuildsInterfaces,
    Contains,
    Custom,
    Defaults,
    EndsCleanly,
    InRange,
    NamesBadValue,
    Node,
    Parameter,
    Program,
    Publishes,
    Rejects,
    Serves,
    Service,
    SetAtRunTime,
    SetAtStart,
    ShownIn,
    SurvivesBadCall,
    Topic,
    check,
    criterion,
)
from tutor.exercise.bad_values import BadValues
from tutor.exercise.defaults import DeclaringRun
from tutor.exercise.ends_cleanly import EndedRun, StartAndEnd
from tutor.exercise.publishing_start import PublishingRun
from tutor.exercise.run_time_changes import RunTimeChanges
from tutor.exercise.service_calls import ServiceCalls
from tutor.exercise.set_at_start import Started, StartedWithParameters
from tutor.exercise.survives_bad_call import CallsAroundBad
from tutor.judge.bench import Bench
from tutor.judge.check import Check
from tutor.judge.interface_build import InterfaceBuild
from tutor.judge.rates import Rate
from tutor.judge.trace import Trace
from tutor.judge.verdict import passed

THERMOSTAT = Program("thermostat.py")
STATE = Topic("/state", "std_msgs/msg/String")
TARGET = Parameter("target", 21.0, ShownIn(Topic("/target", "std_msgs/msg/Float64")))
ROOM = Parameter("room", "hall", ShownIn(STATE))
DOUBLE = Service("/double", "example_interfaces/srv/AddTwoInts", ("a", "b"), "sum", lambda a, b: 2 * a if b else None)

PUBLISHING = graph(publishers={STATE.name: STATE.type})
RUNNING = trace(*samples(STATE.name, 2.0, data="hall: 20 degrees"), graph=PUBLISHING)


def plain(seen: Trace = RUNNING, topic: Topic = STATE) -> PublishingRun:
    return PublishingRun(topic.name, seen, (), None, ending(0))


def test_equal_scenarios_of_two_criteria_are_one() -> None:
    made = check("t1.1", THERMOSTAT, Publishes("state", STATE), Contains("room", STATE, "hall"), EndsCleanly("end"))
    assert len({scenario for criterion in made.criteria for scenario in criterion.facts}) == 1


def test_after_takes_the_criterion() -> None:
    state = Publishes("state", STATE)
    made = check("t1.1", THERMOSTAT, state, Contains("room", STATE, "hall", after=state, bonus=True))
    assert (made.criteria[1].after, made.criteria[1].bonus) == (("state",), True)
    with pytest.raises(ValueError, match="after a criterion that is not before it"):
        check("t1.1", THERMOSTAT, Contains("room", STATE, "hall", after=state), state)


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda: Topic("state", STATE.type), "full name, /state"),
        (lambda: Topic("/state", "String"), "no type such as package/msg/Name"),
        (lambda: Service("/double", STATE.type), "no type such as package/srv/Name"),
        (lambda: Parameter("rooms", ["hall"]), "its default must be"),  # type: ignore[arg-type]
        (lambda: InRange("range", STATE), "has no range"),
        (lambda: SetAtRunTime("set", Parameter("room", "hall"), ("a", "b")), "must have the effect ShownIn"),
        (
            lambda: check("t1.1", THERMOSTAT, Defaults("defaults", (Parameter("room", "hall"),))),
            "no parameter has an effect",
        ),
        (lambda: check("t1.1", THERMOSTAT, Publishes("a", STATE), Publishes("a", STATE)), "repeated"),
    ],
)
def test_an_authors_mistake_is_said_in_one_sentence(made: Callable[[], object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        made()


@pytest.mark.parametrize(("wanted", "is_there"), [("HALL", True), ("20 degrees", True), ("kitchen", False)])
def test_contains_a_text(wanted: str, is_there: bool) -> None:
    made = check("t1.1", THERMOSTAT, Contains("room", STATE, wanted))
    verdict = judge_of(made, "room")(plain())
    assert verdict.passed == is_there
    if not is_there:
        assert_failed(verdict, "wrong values", "kitchen", "hall: 20 degrees", check=made)


def test_contains_a_value() -> None:
    count = Topic("/count", "std_msgs/msg/Int32")
    judge = judge_of(made := check("t1.1", THERMOSTAT, Contains("three", count, 3)), "three")
    three = trace(*(sample(count.name, number, 1001.0 + number) for number in range(4)))
    assert_passed(judge(plain(three, count)))
    assert_failed(judge(plain(trace(sample(count.name, 13, 1001.0)), count)), "wrong values", "13", check=made)
    assert_failed(judge(plain(NO_NODE, count)), "no node", check=made)


def test_a_parameter_without_switch_is_set_at_run_time() -> None:
    made = check("t1.1", THERMOSTAT, SetAtRunTime("set", ROOM, ("kitchen", "attic")))
    judge = judge_of(made, "set")
    set_room = answer({"room": "kitchen"})
    assert_passed(judge(RunTimeChanges(RUNNING, 2.0, set_room, after_value=sample(STATE.name, "kitchen: 20", 1004.0))))
    assert_failed(judge(RunTimeChanges(RUNNING, 2.0, set_room)), "parameter ignored", "hall: 20", check=made)
    refusal = RunTimeChanges(RUNNING, 2.0, refused({"room": "kitchen"}, "no"))
    assert_failed(judge(refusal), "good value refused", check=made)
    assert_failed(judge(RunTimeChanges(RUNNING, 2.0, set_room, went_on=False)), "messages stop", check=made)


def test_a_number_is_shown_as_it_is() -> None:
    made = check("t1.1", THERMOSTAT, SetAtStart("start", ({TARGET: 19.5},)))
    judge, early = judge_of(made, "start"), early_judge_of(made, "start")
    shown = Started(trace(*samples("/target", 2.0, data=19.5)), Rate(2.0, 10, 4.5), 10)
    assert_passed(judge(StartedWithParameters((shown,))))
    other = Started(trace(*samples("/target", 2.0, data=21.0)), Rate(2.0, 10, 4.5), 10)
    for verdict in (judge(StartedWithParameters((other,))), early(StartedWithParameters((other,)))):
        assert verdict is not None
        assert_failed(verdict, "parameter ignored", "target", check=made)
    assert early(StartedWithParameters((None,))) is None


def test_bad_values_are_judged_without_the_other_criteria() -> None:
    made = check("t1.1", THERMOSTAT, Rejects("bad", TARGET, (99.0,)), NamesBadValue("named", TARGET, (99.0,)))
    kept = BadValues(RUNNING, 2.0, 21.0, ((refused({"target": 99.0}, "too hot"), 21.0),), Rate(2.0, 10, 4.5), 10)
    assert_passed(judge_of(made, "bad")(kept))
    taken = replace(kept, rejected=((answer({"target": 99.0}), 99.0),))
    assert_failed(judge_of(made, "bad")(taken), "no validation", "99.0 was accepted", check=made)
    named = replace(trace(logs=[log("target: 99.0 is too hot", 40)]), parameters={"target": 99.0})
    assert_passed(judge_of(made, "named")(DeclaringRun(RUNNING, (), ending(0)), (named,)))


SERVED = graph(services={DOUBLE.name: DOUBLE.type})


def service_check() -> Check:
    serves = Serves("serves", (DOUBLE,), call_with=(2, 1))
    bad = SurvivesBadCall("bad", DOUBLE, good=(2, 1), bad=(2, 0), then=((3, 1), (4, 0)), what="a b of 0", after=serves)
    return check("t1.1", THERMOSTAT, serves, Answers("right", (DOUBLE,), lambda: [(DOUBLE, (5, 1))]), bad)


def test_a_service_of_another_exercise() -> None:
    made = service_check()
    served = ServiceCalls(trace(graph=SERVED), (called("/double", 2, 1, 4),))
    assert_passed(judge_of(made, "serves")(served))
    assert_passed(judge_of(made, "right")(ServiceCalls(trace(graph=SERVED), (called("/double", 5, 1, 10),)), served))
    wrong = ServiceCalls(trace(graph=SERVED), (called("/double", 5, 1, 25),))
    assert_failed(judge_of(made, "right")(wrong, served), "wrong answer", "25 instead of 10", check=made)
    missing = ServiceCalls(trace(graph=PUBLISHING), ())
    assert_failed(judge_of(made, "serves")(missing), "service missing", "/double is not there", check=made)
    assert_skipped(judge_of(made, "right")(wrong, missing), "`serves` did not pass")


@pytest.mark.parametrize("last", [8, 0, -1])
def test_any_answer_is_right_where_the_service_computes_none(last: int) -> None:
    good = called("/double", 2, 1, 4)
    after = (called("/double", 3, 1, 6), called("/double", 4, 0, last))
    complaint = (log("b is 0: error"),)
    seen = CallsAroundBad(trace(graph=SERVED), good, (good, good), called("/double", 2, 0, 0), after, (), complaint)
    assert_passed(judge_of(service_check(), "bad")(seen))


def test_the_end_is_judged_on_a_start_of_its_own_where_no_other_criterion_makes_one() -> None:
    made = check("t1.1", THERMOSTAT, SetAtRunTime("set", ROOM, ("kitchen", "attic")), EndsCleanly("end"))
    assert made.criteria[1].facts == (StartAndEnd(THERMOSTAT),)
    assert_passed(judge_of(made, "end")(EndedRun(RUNNING, ending(0))))
    assert_skipped(judge_of(made, "end")(EndedRun(RUNNING, None)), "`set` shows why")


async def listen(bench: Bench) -> EndedRun:
    raise NotImplementedError


def test_a_criterion_may_bring_its_own_scenarios_and_judge() -> None:
    heard = Custom(
        "heard", lambda seen: passed("something", seen.trace.file), (listen,), ((listen, lambda seen: None),)
    )
    made = check("t1.1", THERMOSTAT, heard, Contains("room", STATE, "hall", after=heard), EndsCleanly("end", listen))
    first, _, last = made.criteria
    assert (first.facts, first.early[0][0], last.facts) == ((listen,), listen, (listen,))
    assert first.judge(EndedRun(RUNNING, None)).observed == "node.py"
    assert_skipped(last.judge(EndedRun(RUNNING, None)), "`heard` shows why")


def test_the_criterion_that_shows_an_early_end_may_be_named() -> None:
    state, room = Publishes("state", STATE), Contains("room", STATE, "hall")
    made = check("t1.1", THERMOSTAT, state, room, EndsCleanly("end", listen, shown_by=room))
    assert_skipped(judge_of(made, "end")(EndedRun(RUNNING, None)), "`room` shows why")


def test_defaults_are_those_of_the_nouns() -> None:
    made = check("t1.1", THERMOSTAT, Defaults("defaults", (TARGET, ROOM)))
    right = (parameter("target", "double", 21.0), parameter("room", "string", "hall"))
    assert_passed(judge_of(made, "defaults")(DeclaringRun(RUNNING, right, ending(0))))
    missing = DeclaringRun(RUNNING, right[:1], ending(0))
    assert_failed(judge_of(made, "defaults")(missing), "parameter not declared", "no room", check=made)


def test_a_function_that_awaits_nothing_is_refused() -> None:
    lines = Path(__file__).read_text().splitlines()
    line = next(number for number, text in enumerate(lines, start=1) if text.strip().startswith("node.rejects("))
    with pytest.raises(ValueError, match=rf"line {line} awaits nothing: write `await node.rejects\(...\)`"):

        @criterion("limits", "bad values are rejected")
        async def limits(node: Node) -> None:
            node.rejects(Parameter("rate", 2.0), -1.0)  # type: ignore[unused-coroutine]


def test_a_function_may_keep_what_it_awaits_later() -> None:
    @criterion("limits", "bad values are rejected")
    async def limits(node: Node) -> None:
        node.expect(1, 1, do="Nothing.")
        later = node.rejects(Parameter("rate", 2.0), -1.0)
        await later

    assert limits.id == "limits"


def test_an_early_end_is_shown_by_what_must_pass_first() -> None:
    types = BuildsInterfaces("types", "hall_interfaces", {})
    state = Publishes("state", STATE, after=types)
    judge = judge_of(check("t1.1", THERMOSTAT, types, state, EndsCleanly("end")), "end")
    ended = replace(plain(trace(graph=graph())), ending=None)
    assert_skipped(judge(ended, ()), "`types` shows why")
    assert_skipped(judge(ended, (InterfaceBuild("hall_interfaces"),)), "`state` shows why")
