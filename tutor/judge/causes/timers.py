"""What a learner's code does with its timers: words for a rate that was seen to be wrong.

As in `parameter_use`, the source only chooses the words; None where it says nothing.
"""

from __future__ import annotations

import re

from tutor.judge.causes import names
from tutor.judge.reading import Assignment, Call, Function, Source
from tutor.judge.verdict import Cause


def callback(source: Source) -> Function | None:
    """The function that the timer calls."""
    for call in source.calls("create_timer"):
        found = source.functions(_callback_of(call).rpartition(".")[2])
        if found:
            return found[-1]
    return None


def post_set(source: Source, name: str) -> str:
    """The step that always lets a timer follow `name`, a rate in Hz: a post-set callback, in full."""
    made = next(iter(source.calls("create_timer")), None)
    timer, tick, keep = "self.timer", "self.timer_callback", ""
    if made is not None:
        tick = _callback_of(made) or tick
        if made.kept.startswith("self."):
            timer = made.kept
        else:
            keep = f"line {made.line}: {timer} = {made.code}\n"
    return (
        f"{keep}add to the end of __init__: self.add_post_set_parameters_callback(self.apply_parameters)\n"
        "and to the class:\n"
        "def apply_parameters(self, params):\n"
        "    for p in params:\n"
        f"        if p.name == '{name}':\n"
        f"            {timer}.cancel()\n"
        f"            {timer} = self.create_timer(1.0 / p.value, {tick})"
    )


def as_period(source: Source, name: str) -> str | None:
    """The step for a rate that is given to a timer as it is, with the lines that do so."""
    wrong = [call for call in source.calls("create_timer") if _is_rate(source, call)]
    right = [call.instead(call.given[0], f"1.0 / {_bracketed(call.given[0])}") for call in wrong]
    return "\n".join(right) or None


def as_rate(source: Source) -> str | None:
    """The step for a period that a timer gets divided."""
    for call in source.calls("create_timer"):
        for line, text in _spots(source, call):
            if found := re.match(r"\d[\d.]* / (.+)", text):
                return f"line {line}: write {found[1]} instead of {text}"
    return None


def ended_for_good(source: Source, name: str) -> str | None:
    """The step where a timer is cancelled when `name` is false, and never made again."""
    tick = callback(source)
    if tick is None:
        return None
    inside = {each.name for each in source.all_functions()} - {"main", "__init__"}
    for call in source.calls("cancel", "destroy_timer"):
        test = next(iter(call.tests), None)
        made = [each for each in source.calls("create_timer") if each.within == call.within and each.line > call.line]
        if call.within not in inside or test is None or (made and made[0].line <= call.line + 2):
            continue
        value = f"self.get_parameter('{name}').value"
        looks = (
            "" if name in tick.code else f"\nbegin {tick.name} (line {tick.line}) with:\nif not {value}:\n    return"
        )
        return f"remove lines {test.line} to {call.line}, which end the timer: {test.code} {call.code}{looks}"
    return None


def idle(source: Source, topic: str) -> Cause | None:
    """Why a publisher that is there never sends anything."""
    if not source.calls("create_publisher", "create_lifecycle_publisher"):
        return None
    sends = source.calls("publish")
    made = next(iter(source.calls("create_publisher", "create_lifecycle_publisher")))
    tick = callback(source)
    if not sends:
        into = f"at the end of {tick.name} (line {tick.line})" if tick else "in the timer's callback"
        message = next((each.target for each in source.assignments() if _is_message(each, made, tick)), "")
        hint = f"add {into}: {made.kept or 'self.publisher'}.publish({message or 'msg'})"
        hint += "" if message else ", with the message that is to be sent"
        return Cause("no messages", f"there is a publisher on {topic}, but nothing calls publish()", hint)
    timers = source.calls("create_timer")
    if (cause := other_unit(source)) is not None:
        return cause
    if not timers and sends[0].within and "while " not in source.text:
        return Cause(
            "no messages",
            f"{sends[0].where} is in {sends[0].within}, which nothing calls: there is no timer",
            "add to the end of __init__: "
            f"self.timer = self.create_timer({_own_period(source)}, self.{sends[0].within})",
        )
    return None


def _is_message(each: Assignment, made: Call, tick: Function | None) -> bool:
    """Whether a message of the publisher's type is made here."""
    return tick is not None and each.within == tick.name and each.value.startswith(f"{made.argument(0, 'msg_type')}(")


def _own_period(source: Source) -> str:
    """The period that the file's own rate asks for, in seconds."""
    for each in source.assignments():
        if re.search(r"get_parameter\('\w*(?:rate|hz|freq)\w*'\)", each.value) and each.target.startswith("self."):
            return f"1.0 / {each.target}"
    return "1.0"


def other_unit(source: Source) -> Cause | None:
    """Whether a period is not 1 divided by a rate, but another number."""
    for call in source.calls("create_timer"):
        period = call.argument(0, "timer_period_sec")
        for line, text in _spots(source, call):
            found = re.match(r"(?P<number>\d[\d.]*(?:e\d+)?) / ", text)
            if found and float(found["number"]) != 1:
                right = text.replace(found["number"], "1.0", 1)
                step = call.instead(period, right) if line == call.line else f"line {line}: {right} instead of {text}"
                return Cause(
                    "wrong timer period",
                    f"line {line}: the period {text} is not the one of this rate: create_timer takes seconds",
                    step,
                )
    return None


def fixed(source: Source, name: str, holder: str) -> Cause | None:
    """Whether the timer has a number as its period, where it should follow the rate that is kept in `holder`."""
    for call in source.calls("create_timer"):
        period = call.argument(0, "timer_period_sec")
        if re.fullmatch(r"[\d.]+( / [\d.]+)?", period):
            return Cause(
                "parameter ignored",
                f"{call.where} has the period {period}, whatever {name} says",
                call.instead(period, f"1.0 / {holder}"),
            )
    return None


def several(source: Source) -> Cause | None:
    """Whether more than one timer is made."""
    tick = callback(source)
    made = source.calls("create_timer")
    inner = next((call for call in made if tick is not None and call.within == tick.name), None)
    if inner is not None and not source.calls("cancel", "destroy_timer"):
        return Cause(
            "wrong rate",
            f"{inner.where} is in {inner.within}, the timer's own callback: each call makes one more timer",
            f"remove line {inner.line}: one timer, made in __init__, goes on by itself",
        )
    first = [call for call in made if call.within == "__init__"]
    same = {_callback_of(call) for call in first}
    if len(first) > 1 and len(same) == 1:
        extra = next(
            (call for call in first if re.fullmatch(r"[\d.]+", call.argument(0, "timer_period_sec"))), first[-1]
        )
        return Cause(
            "wrong rate",
            f"lines {' and '.join(str(call.line) for call in first)} make a timer each, and both call {same.pop()}",
            f"remove line {extra.line}: {extra.code}",
        )
    return None


def _spots(source: Source, call: Call) -> list[tuple[int, str]]:
    """Where a timer's period is worked out, and how."""
    period = call.argument(0, "timer_period_sec")
    return [(call.line, period), *((each.line, each.value) for each in source.assignments(period))]


def whole_division(source: Source) -> Cause | None:
    """Whether a timer's period is divided without decimals."""
    for call in source.calls("create_timer"):
        for line, text in _spots(source, call):
            if "//" in text:
                return Cause(
                    "period made a whole number",
                    f"line {line}: {text} has no decimals: 1 // 5 is 0, and 1 // 0.7 is 1.0",
                    f"line {line}: write / instead of //, {text.replace('//', '/')}",
                )
            if re.match(r"(?:int|round)\(", text):
                return Cause(
                    "period made a whole number",
                    f"line {line}: {text} has no decimals: int(1 / 5) is 0",
                    f"line {line}: leave int() or round() out, and use the value as it is",
                )
    return None


def beside(source: Source) -> str | None:
    """The step where a new timer is made beside the old one, with the lines in question."""
    first, later = _of_init(source), _later(source)
    if first is None or later is None:
        return None
    timer = first.kept if first.kept.startswith("self.") else "self.timer"
    keep = "" if first.kept.startswith("self.") else f"line {first.line}: {timer} = {first.code}\n"
    ends = [call for call in source.calls("cancel", "destroy_timer") if call.within == later.within]
    if not ends or keep:
        again = "" if later.kept == timer else f"\nline {later.line}: {timer} = {later.code}"
        return f"{keep}right before line {later.line}: {timer}.cancel(){again}"
    if later.kept != timer:
        return f"line {later.line}: {timer} = {later.code}"
    if ends[0].line > later.line:
        return f"put line {ends[0].line}, {ends[0].code}, before line {later.line}: now, it ends the new timer"
    return None


def remade(source: Source, changed: Function) -> Call | None:
    """Where a parameter callback makes a new timer."""
    within = {function.name for function in source.reached(changed.name)}
    return next((call for call in source.calls("create_timer") if call.within in within), None)


def stays(source: Source, name: str, made: Call) -> Cause:
    """The code would make a new timer in line `made`, but the rate does not follow."""
    test = next((test for test in made.tests if name not in test.code), None)
    if test is not None:
        return Cause(
            names.TIMER_NOT_REPLACED,
            f"line {made.line} would make a new timer, but only under the condition of {test.where}, and it is not "
            f"reached when {name} changes",
            f"take the condition in line {test.line} away, and let what is below it be done whenever {name} is set",
        )
    return Cause(
        names.TIMER_NOT_REPLACED,
        f"line {made.line} would make a new timer, but it is not reached when {name} changes, or has the old period",
        post_set(source, name),
    )


def _of_init(source: Source) -> Call | None:
    """Where the timer is made to begin with."""
    inside = {function.name for function in source.reached("__init__")}
    return next((call for call in source.calls("create_timer") if call.within in inside), None)


def _later(source: Source) -> Call | None:
    """Where another one is made later."""
    first = _of_init(source)
    return next((call for call in source.calls("create_timer") if first is not None and call.line != first.line), None)


def _callback_of(call: Call) -> str:
    return call.argument(1, "callback")


def _is_rate(source: Source, call: Call) -> bool:
    """Whether what this timer gets as its period is no number, and divided nowhere."""
    if not call.given:
        return False
    period = call.given[0]
    texts = [period, *(each.value for each in source.assignments(period))]
    return not re.fullmatch(r"[\d.]+", period) and not any("/" in text or "period" in text for text in texts)


def _bracketed(text: str) -> str:
    return text if re.fullmatch(r"[\w.()'\"\[\]]+", text) else f"({text})"
