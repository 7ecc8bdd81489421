"""I1.2: which gaps of N are noticed, and which alarms are false."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import pytest

from checks.i1_2_message_statistics.gaps import judge_jumps
from checks.i1_2_message_statistics.plans import JUMP_AFTER, LEFT_OUT, SECOND_JUMP_AFTER
from tests.checks import statistics_nodes as nodes
from tests.checks.builders import assert_passed, trace
from tests.checks.statistics_nodes import MISSING, RIGHT, FakeStats, Make, node, saying_on_any_jump, silent_about_gaps
from tests.checks.statistics_trials import (
    LATE_S,
    assert_all_passed,
    assert_breaks,
    assert_failed,
    judge_trials,
    logged,
    slowly,
    with_log,
    with_trace,
)


def lost_for_ever(node: FakeStats) -> int:
    """What a node counts as lost whose expected number never catches up after a gap."""
    return sum(max(0, number - node.numbers[0] - index) for index, number in enumerate(node.numbers))


LOSS_KEEPS_RISING = silent_about_gaps(
    lambda node: f"{{count}} at {{rate:.1f}}/s, {lost_for_ever(node)} lost: {{first}} to {{last}}"
)
GAPS_KEEP_RISING = silent_about_gaps(lambda node: (
    f"{{count}} at {{rate:.1f}}/s, {node.count - JUMP_AFTER if lost_for_ever(node) else 0} gaps: {{first}} to {{last}}"
))  # fmt: skip
LOSS_KEEPS_RISING_IN_EACH_MESSAGE = silent_about_gaps(
    lambda node: [
        *(["{count} at {rate:.1f}/s: {first} to {last}"] if node.count % 10 == 0 else []),
        f"{{data}}, lost so far: {lost_for_ever(node)}",
    ],
    due=lambda node: True,
)
FALSE_ALARMS: dict[str, Make] = {
    "compares texts, so that 10 is less than 9": nodes.COMPARES_TEXTS,
    "warns for ever after a gap": node(nodes.WarnsForEverAfterAGap),
    "informs for ever after a gap": node(nodes.WarnsForEverAfterAGap, gap=[(20, MISSING)]),
    "a loss that keeps rising": LOSS_KEEPS_RISING,
    "gaps that keep rising": GAPS_KEEP_RISING,
    "a loss that keeps rising, in each message": LOSS_KEEPS_RISING_IN_EACH_MESSAGE,
}
NOT_NOTICED: dict[str, Make] = {
    "says nothing": nodes.GAP_BLIND,
    "says nothing, in many words": silent_about_gaps(nodes.one_line_per_value, heard=nodes.noisy),
    "a word now and then": silent_about_gaps(heard=nodes.now_and_then),
    "an id with each message": silent_about_gaps(
        heard=lambda node: f"message {hash(node.data) & 0xFFFFFF:07x} at 0x{id(node.data):x}"),
    "a rounded rate": silent_about_gaps("{count} ({rate:.0f} Hz) {first} {last}"),
    "a clock": silent_about_gaps(nodes.with_clock),
    "an alarm for every message": silent_about_gaps(heard=[(30, MISSING)]),
    "lists the numbers from the last one on, so that each message is a gap": silent_about_gaps(
        heard=lambda node: [] if node.number is None else [(30, f"missing: {list(range(node.number, node.incoming))}")]
    ),
    "a count of gaps that stays 0": silent_about_gaps("{count} {rate} gaps=0 restarts=0 {first} {last}"),
    "a count of gaps that rises anyway": silent_about_gaps(
        lambda node: f"{{count}} {{rate}} gaps={node.count // 10} {{first}} {{last}}"),
    "a count of gaps that is reset too far": silent_about_gaps(
        lambda node: f"{{count}} at {{rate:.1f}}/s, {max(node.gaps, 0)} gaps: {{first}} to {{last}}",
        at_summary={"gaps": -9}),
    "only lower numbers": silent_about_gaps(fall="sequence went back"),
    "tolerates one missing message": node(gap=lambda node: MISSING if node.missing > 1 else ()),
    "only the first gap": node(gap=lambda node: MISSING if node.gaps == 1 else ()),
    "all but the first gap": nodes.SKIPS_THE_FIRST_GAP,
    "only a gap larger than all before": node(gap=lambda node: MISSING if node.step == node.largest else ()),
}  # fmt: skip
NOT_NOTICED_AFTER_ZERO = {
    "takes 0 for none": nodes.BLIND_AFTER_ZERO,
    "and says late that messages come": node(
        gap=lambda node: MISSING if node.number else (),
        heard=lambda node: "receiving messages" if node.count == 1 else (),
    ),
}
FAULTY_NODES = {
    "false alarm": FALSE_ALARMS, "gap not noticed": NOT_NOTICED, "0 taken for no number": NOT_NOTICED_AFTER_ZERO,
}  # fmt: skip


@pytest.mark.parametrize(
    ("cause", "make"),
    [
        pytest.param(cause, make, id=f"{cause}: {what}")
        for cause, faulty in FAULTY_NODES.items()
        for what, make in faulty.items()
    ],
)
def test_a_node_that_misses_gaps_or_sees_some_everywhere_fails(cause: str, make: Make) -> None:
    assert_breaks(judge_trials(make), f"gaps: {cause}")


@pytest.mark.parametrize("missed", range(LEFT_OUT[0], LEFT_OUT[1] + 1))
@pytest.mark.parametrize(
    ("make", "late_s"),
    [*product([LOSS_KEEPS_RISING, GAPS_KEEP_RISING], [LATE_S, 0.3, 1.0]), (LOSS_KEEPS_RISING_IN_EACH_MESSAGE, LATE_S)],
)
def test_a_loss_that_keeps_rising_is_recognised_whatever_number_is_chosen(
    make: Make, late_s: float, missed: int
) -> None:
    assert_failed(slowly(make, missed=missed, late_s=late_s).judge("gaps"), "false alarm")


FALSE_WHERE_NEGATIVE = [
    "missing {missing} messages",
    "Missed {step} message(s) between {number} and {incoming}",
    "{missing} messages missing between {number} and {incoming}",
    "Gap detected! Lost messages: {missing}",
    "gap from {number} to {incoming}: {missing} messages were lost",
    '{{"last": {number}, "n": {incoming}, "n_missed": {missing}}}',
    "LOST={missing}",
    "skipped {missing}",
    "{missing} Nachrichten fehlen",
    "Es wurden {missing} Nachrichten verloren",
    "Il manque {missing} messages",
    "{missing} 件のメッセージが欠落しました",
    "丢失 {missing} 条消息",
]
TRUE_WHERE_NEGATIVE = [
    "sequence went from {number} to {incoming} ({step})",
    "sequence went from {number} to {incoming} ({step:+d}), messages may be missing",
    "jump of {step}",
    "unexpected jump: {step}. Were messages lost?",
    "lost or restarted? N changed by {step}",
    "off by {missing}",
    "expected the next number, difference {missing}",
    "gap: {step}",
    "N: {number}->{incoming}, delta {step}, missing 0",
    "delta={step} lost=?",
    "step {step} without loss",
    "Fehler: {step}",
    "Sequenzsprung um {step}",
    "Lost the sequence: from {number} to {incoming} ({step})",
    "the sequence changed by {step}; a positive number means that messages are missing",
]


@pytest.mark.parametrize("text", FALSE_WHERE_NEGATIVE)
def test_a_negative_number_of_missing_messages_is_wrong(text: str) -> None:
    assert_breaks(judge_trials(saying_on_any_jump(text)), "gaps: negative number of missing messages")


@pytest.mark.parametrize("text", TRUE_WHERE_NEGATIVE)
def test_a_negative_number_that_is_true_is_right(text: str) -> None:
    assert_all_passed(judge_trials(saying_on_any_jump(text)))


def test_a_count_of_lost_messages_below_zero_is_wrong_in_any_language() -> None:
    """It falls below 0 at a restart; no word says what it is."""
    adds_up_everything = silent_about_gaps(lambda node: (
        f"{{count}} {node.numbers[-1] - node.numbers[0] - node.count + 1} {{rate:.2f}} {{first}} {{last}}"
    ))  # fmt: skip
    assert_breaks(judge_trials(adds_up_everything), "gaps: negative number of missing messages")


@pytest.mark.parametrize("cpu_wait_s", [0.0, 0.02, 2.0])
def test_a_warning_about_one_gap_does_not_cover_the_other(cpu_wait_s: float) -> None:
    trials = slowly(nodes.SKIPS_THE_FIRST_GAP)
    assert_failed(judge_jumps(replace(trials.jump_twice, cpu_wait_s=cpu_wait_s), trials.steady), "gap not noticed")


@pytest.mark.parametrize(
    ("text", "passes"), [("2 gaps", True), (f"{LEFT_OUT[0] + 1} numbers are missing", True), ("a gap", False)]
)
def test_one_message_may_cover_both_gaps_if_the_node_was_starved(text: str, passes: bool) -> None:
    trials = slowly(RIGHT)
    twice = trials.jump_twice
    logs = tuple(log for log in twice.trace.logs if "missing" not in log.text)
    assert len(logs) == len(twice.trace.logs) - 2
    both = with_log(with_trace(twice, logs=logs), text, twice.sent[SECOND_JUMP_AFTER].at + 0.1, 30)
    assert_failed(judge_jumps(both, trials.steady), "gap not noticed")
    verdict = judge_jumps(replace(both, cpu_wait_s=0.5), trials.steady)
    assert verdict.passed == passes, verdict


@pytest.mark.parametrize("cpu_wait_s", [0.0, 2.0])
@pytest.mark.parametrize(("first", "late_s"), [(91, LATE_S), (92, LATE_S), (92, 0.124), (90, LATE_S)])
def test_an_alarm_next_to_a_summary_is_not_one_of_its_lines(first: int, late_s: float, cpu_wait_s: float) -> None:
    trials = slowly(nodes.COMPARES_TEXTS, first=first)
    alarm = next(log for log in trials.jump.trace.logs if log.text == "out of sequence")
    late = logged(alarm.text, alarm.stamp + late_s, 30)
    jump = with_trace(trials.jump, logs=tuple(late if log is alarm else log for log in trials.jump.trace.logs))
    trials = replace(trials, jump=replace(jump, cpu_wait_s=cpu_wait_s))
    assert_passed(trials.judge("summary"))
    assert_passed(trials.judge("count"))
    assert_failed(judge_jumps(trials.jump, trials.steady), "false alarm")


def test_a_gap_that_is_only_printed_fails() -> None:
    trials = slowly(nodes.GAP_BLIND)
    (line,) = trace(out="gap: 5 messages lost").output
    printed = with_trace(trials.jump, output=(replace(line, at=trials.jump.sent[-1].at),))
    assert_failed(judge_jumps(printed, trials.steady), "printed, not logged")
