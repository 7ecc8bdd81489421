"""I1.1: the next step in the words of the learner's own file. The source only chooses the words."""

from __future__ import annotations

import re

from checks.i1_1.facts import HIGHEST, LOWEST
from tutor.judge.causes import parameter_use, timers
from tutor.judge.reading import Source
from tutor.judge.verdict import Cause

DRAW = f"random.uniform({LOWEST}, {HIGHEST})"


def draw(source: Source) -> str | None:
    """The step where the values are not drawn at random, or not from the range."""
    imported = "" if source.imports("random") else "\nat the top of the file: import random"
    tick = timers.callback(source)
    seeded = next((call for call in source.calls("seed") if tick is not None and call.within == tick.name), None)
    if seeded is not None:
        return f"remove line {seeded.line}, {seeded.code}: it begins the same row of numbers again"
    for each in source.assignments():
        if each.target.endswith(".data"):
            return f"line {each.line}: {each.target} = {DRAW}{imported}"
    for call in source.calls("Float64"):
        if (given := call.named.get("data")) is not None:
            return call.instead(f"data={given}", f"data={DRAW}") + imported
    return None


def as_float(source: Source) -> str | None:
    """The step where an int is put into the field."""
    for each in source.assignments():
        if each.target.endswith(".data"):
            return f"line {each.line}: {each.target} = float({each.value})"
    for call in source.calls("Float64"):
        if (given := call.named.get("data")) is not None:
            return call.instead(f"data={given}", f"data=float({given})")
    return None


def rate(source: Source, name: str) -> Cause | None:
    """What keeps the rate from being what a parameter, which is read in Hz, says."""
    holder = parameter_use.holder(source, name)
    if holder is not None and (found := re.search(r"\b(?:int|round)\(", holder.value)):
        right = holder.value.replace(found[0], "float(", 1)
        return Cause(
            "rate made a whole number",
            f"{holder.where} has no decimals: 0.5 becomes 0",
            f"line {holder.line}: {holder.target} = {right}",
        )
    if (cause := timers.whole_division(source) or timers.other_unit(source) or timers.several(source)) is not None:
        return cause
    return (
        parameter_use.not_read(source, name)
        or (timers.fixed(source, name, holder.target) if holder is not None else None)
        or _read_elsewhere(source, name)
    )


def _read_elsewhere(source: Source, name: str) -> Cause | None:
    """Whether another parameter is read than the one that is declared."""
    declared = {call.argument(0, "name") for call in source.calls("declare_parameter")}
    for call in source.calls("get_parameter", "get_parameter_or"):
        wanted = call.argument(0, "name")
        if wanted.startswith("'") and wanted not in declared and f"'{name}'" in declared:
            return Cause(
                "parameter ignored",
                f"{call.where}: no parameter {wanted} is declared",
                f"line {call.line}: self.get_parameter('{name}')"
                + (".value" if call.name == "get_parameter_or" else "")
                + f" instead of {call.code}",
            )
    return None


def whole_rate(source: Source, name: str) -> Cause | None:
    """Whether a rate is cut to a whole number, so that a small one becomes 0."""
    cause = rate(source, name)
    return (
        cause
        if cause is not None and cause.name in ("rate made a whole number", "period made a whole number")
        else None
    )


def name_logged(source: Source, name: str) -> Cause | None:
    """What keeps a text parameter from the log."""
    tick = timers.callback(source)
    holder = parameter_use.holder(source, name)
    if tick is None:
        return None
    value = f"self.get_parameter('{name}').value"
    quiet = [call for call in source.calls("debug") if call.within == tick.name]
    if quiet and (value in quiet[0].code or (holder is not None and holder.target in quiet[0].code)):
        return Cause(
            "logged at DEBUG",
            f"{quiet[0].where}: debug messages are not shown",
            quiet[0].instead(".debug(", ".info("),
        )
    for call in source.calls("info", "warning", "warn"):
        text = call.argument(0, "message")
        if holder is not None and text.startswith(("'", '"')) and f"{{{holder.target}" in text:
            return Cause(
                "no f in front of the text",
                f"{call.where} logs the words {{{holder.target}}}, not the value",
                call.instead(text, f"f{text}"),
            )
    return Cause(
        "parameter ignored",
        f"{name} is declared, but its value is not logged",
        f"begin {tick.name} (line {tick.line}) with: self.get_logger().info({value})",
    )
