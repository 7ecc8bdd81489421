"""I1.2: which gaps of N are noticed, and which alarms are false."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import pytest

from checks.i1_2_message_statistics.gaps import judge_jumps
from checks.i1_2_message_statistics.plans import LEFT_OUT
from tests.checks.builders import trace
from tests.checks.statistics_nodes import (
    GAP_BLIND,
    MISSING,
    Make,
    WarnsForEverAfterAGap,
    gaps_keep_rising,
    loss_keeps_rising,
    lost_for_ever,
    node,
    noisy,
    now_and_then,
    one_line_per_value,
    saying_on_any_jump,
    silent_about_gaps,
    with_clock,
)
from tests.checks.statistics_trials import (
    LATE_S,
    assert_all_passed,
    assert_breaks,
    assert_failed,
    judge_rising,
    judge_trials,
    jump,
    jump_twice,
    steady,
    with_trace,
)

LOSS_KEEPS_RISING = silent_about_gaps(loss_keeps_rising)
GAPS_KEEP_RISING = silent_about_gaps(gaps_keep_rising)
LOSS_KEEPS_RISING_IN_EACH_MESSAGE = silent_about_gaps(
    lambda node: [
        *(["{count} at {rate:.1f}/s: {first} to {last}"] if node.count % 10 == 0 else []),
        f"{{data}}, lost so far: {lost_for_ever(node)}",
    ],
    due=lambda node: True,
)

FAULTY_NODES: dict[str, list[tuple[str, Make]]] = {
    "gap not noticed": [
        ("an alarm for every message", silent_about_gaps(heard=[(30, MISSING)])),
        ("lists the numbers from the last one on, so that each message is a gap", silent_about_gaps(
            heard=lambda node: (
                () if node.number is None else [(30, f"missing: {list(range(node.number, node.incoming))}")]
            )
        )),
        ("says nothing", GAP_BLIND),
        ("says nothing, in many words", silent_about_gaps(one_line_per_value, heard=noisy)),
        ("a word now and then", silent_about_gaps(heard=now_and_then)),
        ("an id with each message", silent_about_gaps(
            heard=lambda node: f"message {hash(node.data) & 0xFFFFFF:07x} at 0x{id(node.data):x}"
        )),
        ("a rounded rate", silent_about_gaps("{count} ({rate:.0f} Hz) {first} {last}")),
        ("a clock", silent_about_gaps(with_clock)),
        ("a count of gaps that stays 0", silent_about_gaps("{count} {rate} gaps=0 restarts=0 {first} {last}")),
        ("a count of gaps that rises anyway", silent_about_gaps(
            lambda node: f"{{count}} {{rate}} gaps={node.count // 10} {{first}} {{last}}"
        )),
        ("only lower numbers are noticed", silent_about_gaps(fall="sequence went back")),
        ("one missing message is tolerated", node(gap=lambda node: MISSING if node.missing > 1 else ())),
        ("only the first gap", node(gap=lambda node: MISSING if node.gaps == 1 else ())),
        ("not the first gap", node(gap=lambda node: MISSING if node.gaps > 1 else ())),
        ("only a gap larger than all before", node(gap=lambda node: MISSING if node.step == node.largest else ())),
        ("a count of gaps that is reset too far", silent_about_gaps(
            lambda node: f"{{count}} at {{rate:.1f}}/s, {max(node.gaps, 0)} gaps: {{first}} to {{last}}",
            at_summary={"gaps": -9},
        )),
    ],
    "false alarm": [
        ("compares texts, so that 10 is less than 9", node(
            heard=lambda node: [(30, "out of sequence")] if node.data < node.last else (), gap="out of sequence"
        )),
        ("warns for ever after a gap", node(WarnsForEverAfterAGap)),
        ("informs for ever after a gap", node(WarnsForEverAfterAGap, gap=[(20, MISSING)])),
        ("a loss that keeps rising", LOSS_KEEPS_RISING),
        ("gaps that keep rising", GAPS_KEEP_RISING),
        ("a loss that keeps rising, in each message", LOSS_KEEPS_RISING_IN_EACH_MESSAGE),
    ],
    "0 taken for no number": [
        ("a jump after zero", node(gap=lambda node: MISSING if node.number else ())),
        ("a jump after zero, and says late that messages come", node(
            gap=lambda node: MISSING if node.number else (),
            heard=lambda node: "receiving messages" if node.count == 1 else (),
        )),
    ],
    "negative number of missing messages": [
        (text, saying_on_any_jump(text))
        for text in (
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
        )
    ]
    + [
        ("a total that falls below 0 at a restart, in no words", silent_about_gaps(
            lambda node: (
                f"{{count}} {node.numbers[-1] - node.numbers[0] - node.count + 1} {{rate:.2f}} {{first}} {{last}}"
            )
        )),
    ],
}  # fmt: skip


@pytest.mark.parametrize(
    ("cause", "make"),
    [pytest.param(cause, make, id=f"{cause}, {what}") for cause, makes in FAULTY_NODES.items() for what, make in makes],
)
def test_a_gap_that_is_not_noticed_or_none(cause: str, make: Make) -> None:
    assert_breaks(judge_trials(make), "gaps", cause)


@pytest.mark.parametrize(
    "text",
    [
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
    ],
)
def test_a_negative_number_that_is_true_is_right(text: str) -> None:
    assert_all_passed(judge_trials(saying_on_any_jump(text)))


@pytest.mark.parametrize("missed", range(LEFT_OUT[0], LEFT_OUT[1] + 1))
@pytest.mark.parametrize(
    ("make", "late_s"),
    [*product([LOSS_KEEPS_RISING, GAPS_KEEP_RISING], [LATE_S, 0.3, 1.0]), (LOSS_KEEPS_RISING_IN_EACH_MESSAGE, LATE_S)],
)
def test_a_loss_that_keeps_rising_is_recognised_whatever_number_is_chosen(
    make: Make, late_s: float, missed: int
) -> None:
    trials = jump(make(), missed, late_s=late_s), jump_twice(make(), missed, late_s=late_s)
    assert_failed(judge_rising(*trials, steady(make(), late_s=late_s)), "false alarm")


def test_a_gap_that_is_only_printed_fails() -> None:
    jump_trial = jump(GAP_BLIND())
    (line,) = trace(out="gap: 5 messages lost").output
    printed = with_trace(jump_trial, output=(replace(line, at=jump_trial.sent[-1].at),))
    assert_failed(judge_jumps(printed, steady(GAP_BLIND())), "printed, not logged")
