"""I1.2: a negative number of missing messages, as some nodes state it when N falls.

That N went from 57 to 0, or by -57, is true. What is false is that a negative number of messages is missing: one that
words for a loss go with, in one of some languages, or one in the place where the node states the loss at a jump.
"""

from __future__ import annotations

import re

from checks.i1_2_message_statistics.log_lines import Line
from checks.i1_2_message_statistics.trial import Trial

_LOSS = (
    r"(?<![^\W\d_])(?:miss(?:ing|ed|es)?|lost|loss|losing|drop|skip|fehl(?!er)|verlor|verlust|verpass|übersprung"
    r"|ausgelassen|perdu|perte|manqu|perdid|pérdid|falta|saltad|mancant|pers[ieoa]\b|zgub|utrac|brakuj"
    r"|потер|пропущ|утер)[^\W\d_]*|欠落|欠番|欠け|失われ|丢失|缺失|遗漏|누락|손실"
)
_NEGATIVE = r"(?<![\w.,)\]])[-\u2212]\d+"
_BESIDE = r"[^\d()\[\]{},;.!?|]*?"
_OTHERWISE = re.compile(  # the number is something else, or the loss is denied
    r"\b(?:jump|step|offset|diff|delta|change|from|sprung|schritt|von|no|not|nothing|none|never|without|kein|nicht|ohne"
    r"|pas|sans|sin|senza|non)",
    re.IGNORECASE,
)
_STATED = re.compile(
    rf"(?:\b\w+\W{{1,3}})?(?:{_LOSS}){_BESIDE}{_NEGATIVE}"
    rf"|{_NEGATIVE}{_BESIDE}(?:{_LOSS})(?!\w*[\"']?\s*[:=])(?!\W*\d)",
    re.IGNORECASE,
)


def find_negative_loss(restart: Trial, jump: Trial, jump_twice: Trial, steady: Trial) -> Line | None:
    """The first line since the new publisher's first message that states a negative number of missing messages."""
    if not restart.jumps:
        return None
    for line in restart.lines:
        if line.at < restart.sent[restart.before_break].at:
            continue
        stated = any(not _OTHERWISE.search(found[0]) for found in _STATED.finditer(line.text))
        if stated or _is_negative_total(line, jump, jump_twice, steady):
            return line
    return None


def _is_negative_total(line: Line, jump: Trial, jump_twice: Trial, steady: Trial) -> bool:
    """Whether a number in the line is negative, and elsewhere 0 and then the total of missing messages."""
    others = [
        (other, trial.missed(other.messages))
        for trial in (steady, jump, jump_twice)
        for other in trial.lines
        if other.kind == line.kind
    ]
    if {len(missed) for _, missed in others} != {0, 1, 2}:
        return False
    return any(
        number.value < 0
        and all(len(other.numbers) > place and other.numbers[place].value == sum(missed) for other, missed in others)
        for place, number in enumerate(line.numbers)
    )
