"""What a learner's code does with the parameters that it declares: words for what was seen of the node.

Everything here explains a failure that is certain; what the source says only chooses the words. Where it says nothing
(None), the caller has plainer words.
"""

from __future__ import annotations

import difflib
import re
from typing import Any

from tutor.judge.causes import timers
from tutor.judge.reading import Assignment, Call, Function, Source
from tutor.judge.verdict import Cause

_ON, _POST, _PRE = (
    "add_on_set_parameters_callback",
    "add_post_set_parameters_callback",
    "add_pre_set_parameters_callback",
)
_READING = ("get_parameter", "get_parameter_or", "declare_parameter")
_SETTING = ("set_parameters", "set_parameters_atomically")
_IN_INIT = "__init__"


def overridden(source: Source, name: str) -> Cause | None:
    """Whether the code itself gives the parameter, or what it has read of it, another value."""
    for call in source.calls(*_SETTING):
        around = source.functions(call.within)
        if _says(call.code, name) or any(name in function.texts for function in around if call.code.count("[") == 0):
            return Cause(
                "value overwritten by the node",
                f"{call.where} sets {name} itself, so that the value somebody gives it does not last",
                f"remove this call in line {call.line}: a node reads its parameters, and others set them",
            )
    for call in source.calls("declare_parameter"):
        if _says(call.argument(0, "name"), name) and call.named.get("ignore_override") == "True":
            return Cause(
                "value overwritten by the node",
                f"{call.where}: with ignore_override=True, the value given at start-up is not taken",
                f"leave ignore_override=True out of line {call.line}",
            )
    kept = holder(source, name)
    if kept is None:
        return None
    for later in source.assignments(kept.target):
        if later.constant and (later.line > kept.line if later.within == kept.within else later.within != _IN_INIT):
            return Cause(
                "value overwritten by the node",
                f"{later.where} overwrites what line {kept.line} has read of {name}",
                f"remove line {later.line}",
            )
    return None


def not_read(source: Source, name: str) -> Cause | None:
    """What keeps the value that is given at start-up from being used."""
    return overridden(source, name) or _never_read(source, name)


def not_followed(source: Source, name: str) -> Cause | None:
    """What keeps a value that is set while the node runs from being used."""
    if (cause := overridden(source, name) or not_called(source)) is not None:
        return cause
    kept, tick = holder(source, name), timers.callback(source)
    if kept is None:
        return _never_read(source, name)
    if tick is None or not kept.target.startswith("self."):
        return None
    again = f"begin {tick.name} (line {tick.line}) with: {kept.target} = self.get_parameter('{name}').value"
    if (early := _reads_early(source, name)) is not None:
        return _old_value(source, early, name)
    changed = callback(source)
    if changed is None:
        text = f"{kept.where} is run once, when the node starts; nothing reads {name} after that"
        return Cause("parameter ignored", text, again)
    if not any(name in function.texts for function in source.reached(changed.name)):
        return Cause("parameter ignored", f"{changed.name} (line {changed.line}) does nothing for '{name}'", again)
    return Cause(
        "parameter ignored",
        f"what {tick.name} uses, {kept.target}, is not what {changed.name} (line {changed.line}) sets",
        again,
    )


def not_called(source: Source) -> Cause | None:
    """Whether a parameter callback that the code has is never called, or not the one that is meant."""
    for registered in source.calls(_ON, _POST):
        given = registered.argument(0, "callback")
        if given.endswith(")"):
            return Cause(
                "callback not registered",
                f"{registered.where} calls the callback at once, and registers what it returns",
                f"line {registered.line}: self.{registered.name}({given.partition('(')[0]}), without the ()",
            )
        twice = source.functions(given.rpartition(".")[2])
        if len(twice) > 1 and len({each.owner for each in twice}) == 1:
            first, last = twice[0], twice[-1]
            return Cause(
                "callback defined twice",
                f"{first.name} is defined in line {first.line} and again in line {last.line}: the second replaces the "
                "first, which is never called",
                f"remove the one in line {last.line}, or move its lines into the one in line {first.line}",
            )
        if registered.within and registered.within != _IN_INIT and not _leads_to(source, registered.within):
            return Cause(
                "callback not registered",
                f"{registered.where} stands in {registered.within}, which nothing calls when the node starts",
                f"move this line into {_IN_INIT}",
            )
    if source.calls(_ON, _POST, _PRE):
        return None
    meant = _meant(source)
    if meant is None:
        return None
    return Cause(
        "callback not registered",
        f"there is {meant.name} (line {meant.line}), but nothing ever calls it",
        f"register it in {_IN_INIT}, after the parameters are declared: self.{_ON}(self.{meant.name})",
    )


def not_refused(source: Source, name: str, bad: float) -> Cause | None:
    """What keeps a bad number from being refused."""
    if (cause := not_called(source)) is not None:
        return cause
    checker = callback(source, _ON)
    if checker is None:
        return _no_checker(source, name)
    hint = _check_first(source, checker, name)
    reached = source.reached(checker.name)
    if not any("successful=False" in each.code or "successful = False" in each.code for each in reached):
        text = f"{checker.name} (line {checker.line}) never says no: nothing rejects {bad}"
        return Cause("no validation", text, hint)
    return Cause(
        "no validation",
        f"{checker.name} (line {checker.line}) can say no, but does not for {bad}: it has to look at the new value, "
        "the one in its argument, and at every number that is 0 or less",
        hint,
    )


def declared_right(source: Source, name: str, default: Any) -> str:
    """The step where a parameter is not declared, or has another default or type than it should."""
    right = f"self.declare_parameter('{name}', {default!r})"
    for call in source.calls("declare_parameter"):
        if _says(call.argument(0, "name"), name):
            given = call.argument(1, "value")
            return call.instead(given, repr(default)) if given else call.becomes(right)
    for call in source.calls("declare_parameters"):
        if _says(call.code, name):
            return f"line {call.line}: ('{name}', {default!r}) in the list of {call.name}"
    others = {
        call.argument(0, "name").strip("'"): call
        for call in source.calls("declare_parameter")
        if call.argument(0, "name").startswith("'")
    }
    near = [
        each
        for each in others
        if each in name or name in each or difflib.SequenceMatcher(None, each, name).ratio() > 0.6
    ]
    if near:
        lines = ", ".join(map(str, source.lines_with(near[0])))
        return f"write '{name}' instead of '{near[0]}', wherever it is the parameter's name: line {lines}"
    return f"add to __init__: {right}"


def checked_too_late(source: Source, name: str) -> str | None:
    """The step where a value is looked at when something has been done with it already, or with another one."""
    checker = callback(source, _ON)
    return _check_first(source, checker, name) if checker is not None else None


def without_reason(source: Source, name: str) -> str | None:
    """The step where a refusal gives no reason."""
    for call in source.calls("SetParametersResult"):
        if call.named.get("successful") == "False" and call.named.get("reason", "''") in ("''", "' '"):
            bare = re.sub(r",? reason='\s*'", "", call.code)
            return call.becomes(f"{bare[:-1]}, reason='{name} must be > 0')")
    return checked_too_late(source, name)


def checked_at_start(source: Source, name: str) -> str | None:
    """The step that lets a node complain about a bad value that it is started with."""
    declared = next((c for c in source.calls("declare_parameter", "declare_parameters") if _says(c.code, name)), None)
    if declared is None or not declared.within:
        return None
    return (
        f"right after line {declared.line}, {source.line(declared.line)}\n"
        f"if self.get_parameter('{name}').value <= 0.0:\n"
        f"    self.get_logger().fatal('{name} must be > 0')\n"
        "    raise SystemExit(1)"
    )


def _check_first(source: Source, checker: Function, name: str) -> str:
    lines = _check(checker.arguments[0] if checker.arguments else "params", name)
    imported = "" if source.imports("SetParametersResult") else "from rcl_interfaces.msg import SetParametersResult\n"
    return f"begin {checker.name} (line {checker.line}) with:\n{imported}{lines}"


def _no_checker(source: Source, name: str) -> Cause:
    """Nothing is registered that could refuse."""
    text = "nothing can reject a value: no on-set-parameters callback is registered"
    if (post := callback(source, _POST)) is not None:
        text = f"{post.name} (line {post.line}) is called when the value is set already: it cannot reject any"
    return Cause(
        "no validation",
        text,
        f"add to {_IN_INIT}: self.{_ON}(self.check_parameters)\n"
        "and at the top of the file: from rcl_interfaces.msg import SetParametersResult\n"
        "and to the class:\n"
        "def check_parameters(self, params):\n"
        + _indented(_check("params", name))
        + "\n    return SetParametersResult(successful=True)",
    )


def _check(argument: str, name: str) -> str:
    return (
        f"for p in {argument}:\n"
        f"    if p.name == '{name}' and p.value <= 0.0:\n"
        f"        return SetParametersResult(successful=False, reason='{name} must be > 0')"
    )


def callback(source: Source, *kinds: str) -> Function | None:
    """The parameter callback that is registered (as one of `kinds`, or as any)."""
    for registered in source.calls(*(kinds or (_ON, _POST))):
        found = source.functions(registered.argument(0, "callback").rpartition(".")[2])
        if found:
            return found[-1]
    return None


def old_value_read(source: Source, name: str) -> Cause | None:
    """Whether an on-set callback reads the parameter from the node, where it has its old value still."""
    early = _reads_early(source, name)
    return None if early is None else _old_value(source, early, name)


def _old_value(source: Source, early: Call, name: str) -> Cause:
    checker = callback(source, _ON)
    loop = re.search(rf"for (\w+) in {checker.arguments[0]}:", checker.code) if checker and checker.arguments else None
    if checker is not None and loop is not None and early.within == checker.name:
        hint = f"line {early.line}: write {loop[1]}.value instead of {early.code}.value"
    else:
        hint = timers.post_set(source, name)
    return Cause(
        "old value used",
        f"{early.where} still gives the old value here: an on-set callback is called before the new one is stored",
        hint,
    )


def _reads_early(source: Source, name: str) -> Call | None:
    checker = callback(source, _ON)
    if checker is None:
        return None
    within = {function.name for function in source.reached(checker.name)} - _of_timers(source)
    reads = (call for call in source.calls("get_parameter") if _says(call.argument(0, "name"), name))
    return next((call for call in reads if call.within in within), None)


def _of_timers(source: Source) -> set[str]:
    """The functions that timers call: made anew in a parameter callback, they are called later."""
    return {call.argument(1, "callback").rpartition(".")[2] for call in source.calls("create_timer")}


def _never_read(source: Source, name: str) -> Cause | None:
    reading = ("get_parameter", "get_parameter_or", "get_parameters", "get_parameters_by_prefix")
    if not source.calls("declare_parameter", "declare_parameters") or source.calls("get_parameters_by_prefix"):
        return None
    if any(_says(call.code, name) for call in source.calls(*reading)) or holder(source, name) is not None:
        return None
    changed, tick = callback(source), timers.callback(source)
    if changed is not None and any(name in function.texts for function in source.reached(changed.name)):
        return None
    value = f"self.get_parameter('{name}').value"
    made = next(iter(source.calls("create_timer")), None)
    if "rate" in name and made is not None and made.given:
        hint = made.instead(made.given[0], f"1.0 / {value}")
    elif "rate" in name and made is None and (nap := _nap(source)) is not None:
        node = "self" if nap.within and nap.within != "main" else _node(source)
        hint = nap.instead(nap.given[0], f"1.0 / {node}.get_parameter('{name}').value")
    elif name == "enabled" and tick is not None:
        hint = f"begin {tick.name} (line {tick.line}) with:\nif not {value}:\n    return"
    else:
        where = f" in {tick.name} (line {tick.line})" if tick else ""
        hint = f"put {value} where its value is to be used{where}"
    return Cause("parameter ignored", f"{name} is declared, but its value is read nowhere", hint)


def _nap(source: Source) -> Call | None:
    """A sleep of so many seconds, where there is only one: the pace of a loop that does without a timer."""
    naps = [call for call in source.calls("sleep") if call.given and re.fullmatch(r"[\d.]+", call.given[0])]
    return naps[0] if len(naps) == 1 else None


def _node(source: Source) -> str:
    """What the node is called outside of its class."""
    classes = [name for name, bases in source.bases().items() if any("Node" in base for base in bases)]
    return next((call.kept for call in source.calls(*classes, "create_node") if call.kept), "node")


def holder(source: Source, name: str) -> Assignment | None:
    """Where the parameter's value is kept."""
    for each in source.assignments():
        if any(f"{reading}('{name}'" in each.value for reading in _READING):
            return each
    return None


def _meant(source: Source) -> Function | None:
    """A function that nothing calls, and that looks like a parameter callback."""
    functions = source.all_functions()
    called = frozenset().union(*(function.calls for function in functions))
    for function in functions:
        if len(function.arguments) == 1 and function.name not in called and "SetParametersResult" in function.calls:
            return function
    return None


def _leads_to(source: Source, name: str) -> bool:
    """Whether the constructor calls this function, directly or not."""
    return any(name == function.name for function in source.reached(_IN_INIT))


def _says(code: str, name: str) -> bool:
    return f"'{name}'" in code


def _indented(text: str) -> str:
    return "\n".join(f"    {line}" for line in text.splitlines())
