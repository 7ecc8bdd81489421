"""Every format reports the same, and nothing that a learner's process writes can break one."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.report.shape import assert_junit, assert_report_shape
from tutor.judge.result import CriterionResult, Environment, ExerciseResult, Remark, Report
from tutor.judge.verdict import Status, Verdict, fault, passed, skipped
from tutor.report import FORMATS, render

ENVIRONMENT = Environment(ros_distro="jazzy", ros="bundled", rmw="rmw_fastrtps_cpp", ros_tutor="0.1.0")

RATE = Verdict(
    Status.FAILED,
    "2.0 Hz ±20 % with publish_rate:=2.0",
    "0.5 Hz over 5 samples",
    "rate used as a period: the timer fires every 2.0 s",
    "create the timer with 1.0 / rate",
    ("[INFO] [node]: a | b", '  File "my_node.py", line 3, in <module>'),
    mistake="rate-used-as-a-period",
)
SAME = replace(RATE, cause="for the same reason as `rate`", step="", same_as="rate", evidence=())
REMARKS = (
    Remark("shutdown-after-ctrl-c", "line 61 raises RCLError", "temperature_publisher.py", 61),
    Remark("some-other", "an integer is declared: <b>*5.0*</b> ends the node", "temperature_publisher.py", 14),
)


def criterion(identity: str, verdict: Verdict, bonus: bool = False) -> CriterionResult:
    return CriterionResult(identity, f"What {identity} asks for.", bonus, verdict, 1.23456)


def report(*criteria: CriterionResult) -> Report:
    exercise = ExerciseResult("i1.1", "Sensor Publisher", ("temperature_publisher.py",), criteria, 3.98765)
    return Report(ENVIRONMENT, (exercise,), 4.19876)


@pytest.fixture
def mixed() -> Report:
    return report(
        criterion("publishes", passed("messages", "5 messages")),
        criterion("rate", RATE),
        criterion("echo", skipped("not judged, because `publishes` did not pass")),
        criterion("random", fault("no free domain id", "close other checks")),
        criterion("shutdown", RATE, bonus=True),
    )


def test_json_follows_the_contract(mixed: Report) -> None:
    document = json.loads(render(mixed, "json"))
    assert_report_shape(document)
    assert document["verdict"] == "failed"
    assert document["duration_s"] == 4.199
    assert document["environment"]["ros"] == "bundled"
    exercise = document["exercises"][0]
    assert exercise["submission"] == ["temperature_publisher.py"]
    assert exercise["criteria"][1] == {
        "id": "rate",
        "text": "What rate asks for.",
        "bonus": False,
        "status": "failed",
        "duration_s": 1.235,
        "expected": "2.0 Hz ±20 % with publish_rate:=2.0",
        "observed": "0.5 Hz over 5 samples",
        "cause": "rate used as a period: the timer fires every 2.0 s",
        "step": "create the timer with 1.0 / rate",
        "mistake": "rate-used-as-a-period",
        "same_as": None,
        "evidence": ["[INFO] [node]: a | b", '  File "my_node.py", line 3, in <module>'],
    }


def test_text_has_a_word_for_every_status_and_the_next_step(mixed: Report) -> None:
    text = render(mixed, "text", width=100)
    lines = text.splitlines()
    assert lines[0] == "i1.1 Sensor Publisher  FAILED  1 of 4 passed, bonus 0 of 1, 4.0 s"
    for word in ("✓ passed   publishes", "✗ failed   rate", "- skipped  echo", "! error    random"):
        assert any(line.startswith(word) for line in lines)
    assert "    next step  create the timer with 1.0 / rate" in lines
    assert '               File "my_node.py", line 3, in <module>' in [
        re.sub(" {15,}", " " * 15, line) for line in lines
    ]
    assert "It is no fault of your code." in text
    assert "(bonus)" in text
    assert "\x1b" not in text
    assert not any(line != line.rstrip() for line in lines)
    assert lines[-2:] == ["✗ failed  in 4.2 s", "ROS 2 jazzy (bundled), rmw_fastrtps_cpp, ros-tutor 0.1.0"]


@pytest.mark.parametrize("width", [20, 40, 60, 100, 200])
def test_text_keeps_to_the_width_and_loses_no_word(mixed: Report, width: int) -> None:
    text = render(mixed, "text", width=width)
    assert max(map(len, text.splitlines())) <= max(width, 40)
    words = " ".join(text.split())
    for word in ("publish_rate:=2.0", "timer", "temperature_publisher.py", "rmw_fastrtps_cpp"):
        assert word in words


def test_text_has_colour_only_on_request(mixed: Report) -> None:
    colored = render(mixed, "text", color=True, width=100)
    assert "\x1b[31m" in colored
    plain = re.sub(r"\x1b\[[0-9;]*m", "", colored)
    assert [line.rstrip() for line in plain.splitlines()] == render(mixed, "text", width=100).splitlines()


def test_junit_counts_and_keeps_bonus_from_turning_a_build_red(mixed: Report) -> None:
    root = ElementTree.fromstring(render(mixed, "junit"))
    assert_junit(root)
    suite = root[0]
    assert {name: suite.get(name) for name in ("tests", "failures", "errors", "skipped")} == {
        "tests": "5",
        "failures": "1",
        "errors": "1",
        "skipped": "2",
    }
    assert root.get("tests") == "5"
    failure = suite.find("testcase[@name='rate']/failure")
    assert failure is not None
    assert failure.get("message") == "rate used as a period: the timer fires every 2.0 s"
    assert "next step: create the timer with 1.0 / rate" in (failure.text or "")
    bonus = suite.find("testcase[@name='shutdown']/skipped")
    assert bonus is not None
    assert (bonus.get("message") or "").startswith("bonus, failed:")


def test_markdown_escapes_what_it_quotes(mixed: Report) -> None:
    text = render(mixed, "markdown")
    assert text.startswith("# ros-tutor: failed\n")
    assert "| ✗ failed | rate | What rate asks for. | 1.2 s |" in text
    assert "- **observed:** 0.5 Hz over 5 samples" in text
    assert "- **expected:** 2.0 Hz ±20 % with publish\\_rate:=2.0" in text
    assert "```text\n[INFO] [node]: a | b\n" in text
    assert "<details open><summary>✗ rate: failed</summary>\n\n- **expected:**" in text
    assert "<details><summary>✗ shutdown: failed (bonus)</summary>\n" in text
    assert text.count("<details") == text.count("\n</details>\n") == 4


def test_markdown_of_several_exercises_begins_with_an_overview() -> None:
    one = report(criterion("a", passed("", ""))).exercises[0]
    text = render(Report(ENVIRONMENT, (one, missing("i2.1")), 1.0), "markdown")
    assert "1 of 2 exercises passed, ROS 2 jazzy" in text
    assert "| ✓ passed | i1.1 Sensor Publisher | 1 of 1 passed | 4.0 s |" in text
    assert "| ✗ failed | i2.1 Sensor Publisher | not started | 0.0 s |" in text
    assert "\nnot started; \\`ros-tutor start i2.1\\` makes it\n" in text


def test_a_missing_submission_fails_in_every_format() -> None:
    one = report(criterion("a", passed("", ""))).exercises[0]
    both = Report(ENVIRONMENT, (one, missing("i2.1")), 1.0)
    assert both.verdict is Status.FAILED
    assert "i2.1 Sensor Publisher  FAILED\n  not started; `ros-tutor start i2.1` makes it\n" in render(both, "text")
    document = json.loads(render(both, "json"))
    assert_report_shape(document)
    assert [(c["status"], c["cause"]) for c in document["exercises"][1]["criteria"]] == [("skipped", "not started")] * 2
    suite = ElementTree.fromstring(render(both, "junit"))[1]
    assert [suite.get(name) for name in ("tests", "failures", "skipped")] == ["2", "1", "1"]


NASTY = [
    "]]> <![CDATA[ </failure> &lt; &amp;",
    "a | b || `c` ``d``",
    "@somebody $x$ <script>alert(1)</script> </details>",
    "\x1b[31mred\x00\x07\x85\ufffe\ud83d",
    "🤖 ünïcödé \u202e \u2028 end",
    "x" * 100_000,
    "first\nsecond\r\nthird\n```\n# heading\n",
]


@pytest.mark.parametrize("text", NASTY)
def test_junit_copes_with_text_that_xml_cannot_hold(text: str) -> None:
    root = ElementTree.fromstring(render(nasty_report(text), "junit"))
    assert_junit(root)
    failure = root.find("testsuite/testcase/failure")
    assert failure is not None
    assert failure.text is not None
    assert max(map(len, failure.text.split("\n"))) <= 2000 + len("next step: ")
    assert len(failure.get("message") or "") <= 300


@pytest.mark.parametrize("text", NASTY)
def test_markdown_shows_a_learners_output_as_plain_text(text: str) -> None:
    rendered = render(nasty_report(text), "markdown")
    lines = rendered.splitlines()
    fences = [line for line in lines if line.startswith("```")]
    opening = next(fence for fence in fences if fence.endswith("text"))
    block = rendered.partition(opening)[2].partition("\n" + opening.removesuffix("text") + "\n")[0]
    outside = rendered.replace(block, "")
    assert not re.search(r"(?<!\\)<(?!/?details|/?summary|!-- -->)", outside)
    assert not re.search(r"@\w", outside)
    assert not re.search(r"(?<!\\)`", outside.replace(opening, "").replace(opening.removesuffix("text"), ""))
    rows = [line for line in lines if line.startswith("| ")]
    assert {len(re.findall(r"(?<!\\)\|", row)) for row in rows} == {5}
    assert rendered.count("\n</details>\n") >= 1
    assert max(map(len, lines)) < 5000


def nasty_report(text: str) -> Report:
    verdict = Verdict(Status.FAILED, text, text, f"no spin: {text}", text, (text, "last"))
    return report(CriterionResult("x", text, False, verdict, 1.0))


def missing(exercise: str) -> ExerciseResult:
    verdict = Verdict(Status.SKIPPED, cause="not started", step=f"`ros-tutor start {exercise}` makes it")
    criteria = (criterion("a", verdict), criterion("b", verdict, bonus=True))
    return ExerciseResult(exercise, "Sensor Publisher", (), criteria, 0.0)


def test_a_fence_in_the_evidence_does_not_end_the_block() -> None:
    text = render(report(criterion("x", Verdict(Status.FAILED, evidence=("```", "after")))), "markdown")
    assert "````text\n```\nafter\n````" in text


def test_several_exercises_have_a_common_summary() -> None:
    one = report(criterion("a", passed("", ""))).exercises[0]
    two = report(criterion("a", RATE)).exercises[0]
    text = render(Report(ENVIRONMENT, (one, two), 1.0), "text")
    assert text.splitlines()[-2].startswith("✗ failed  1 of 2 exercises passed  in 1.0 s")


nasty = st.text(st.sampled_from("\x00\x07\x1b\x7f\x9b\r\n\t\ud800\ufffe<>&\"'|`*_[]\\ab é✓"), max_size=12) | st.text(
    max_size=12
)


@settings(max_examples=40, deadline=None)
@given(nasty, nasty, st.sampled_from(list(Status)))
def test_no_text_from_a_learner_breaks_a_format(text: str, line: str, status: Status) -> None:
    hostile = report(criterion("x", Verdict(status, text, text, text, text, (line, text))))
    for format in FORMATS:
        rendered = render(hostile, format)
        rendered.encode("utf-8")
        assert rendered.endswith("\n")
        assert not re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f]", rendered)
    assert_report_shape(json.loads(render(hostile, "json")))
    assert_junit(ElementTree.fromstring(render(hostile, "junit")))


def test_a_root_is_told_once_in_every_format() -> None:
    told = report(criterion("rate", RATE), criterion("echo", SAME))
    for format in FORMATS:
        text = render(told, format)
        assert text.count("the timer fires every 2.0 s") == (2 if format == "junit" else 1)  # in junit a message, too
        assert "for the same reason as" in text
    rate, echo = json.loads(render(told, "json"))["exercises"][0]["criteria"]
    assert (rate["mistake"], rate["same_as"]) == ("rate-used-as-a-period", None)
    assert (echo["mistake"], echo["same_as"], echo["step"]) == ("rate-used-as-a-period", "rate", "")
    text = render(told, "text")
    assert text.count("ros-tutor explain rate-used-as-a-period") == 1


def test_remarks_follow_a_pass_in_every_format_and_change_no_verdict() -> None:
    good = report(criterion("publishes", passed("messages", "5 messages")))
    remarked = replace(good, exercises=(replace(good.exercises[0], remarks=REMARKS),))
    assert remarked.verdict is Status.PASSED

    text = render(remarked, "text")
    assert "PASSED" in text
    assert re.search(r"^This works, but …$", text, re.MULTILINE)
    assert "Line 61 raises RCLError" in text
    assert "Line 14: an integer is declared" in text
    assert "ros-tutor explain shutdown-after-ctrl-c" in text

    document = json.loads(render(remarked, "json"))
    assert_report_shape(document)
    assert document["verdict"] == "passed"
    assert document["exercises"][0]["remarks"][0] == {
        "mistake": "shutdown-after-ctrl-c",
        "text": "line 61 raises RCLError",
        "file": "temperature_publisher.py",
        "line": 61,
    }

    root = ElementTree.fromstring(render(remarked, "junit"))
    assert_junit(root)
    assert (root.get("failures"), root.get("errors")) == ("0", "0")
    assert "This works, but …\nLine 61 raises RCLError" in (root[0].findtext("system-out") or "")

    markdown = render(remarked, "markdown")
    assert "**This works, but …**" in markdown
    assert "- Line 61 raises RCLError More: `ros-tutor explain shutdown-after-ctrl-c`" in markdown
    assert "<b>" not in markdown

    several = replace(remarked.exercises[0], submission=("a.py", "temperature_publisher.py"))
    text = render(replace(remarked, exercises=(several,)), "text")
    assert "temperature_publisher.py: line 61 raises RCLError" in text
    for format in FORMATS:
        assert "This works, but" not in render(good, format)
