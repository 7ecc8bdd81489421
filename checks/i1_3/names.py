"""I1.3: a client that asks for what our servers do not offer, in the words of its source."""

from __future__ import annotations

import ast
import difflib
import re
from collections.abc import Sequence

from checks.i1_3.facts import SIGNS, TYPE, Demonstration
from tutor.judge import source
from tutor.judge.trace import Service, Trace
from tutor.judge.verdict import Cause


def of_client(seen: Demonstration, missing: Sequence[str]) -> Cause | None:
    """Whether a service client asks for a name, or a type, that no service of ours has; some are `missing` calls."""
    if seen.trace is None or not missing:
        return None
    asked = sorted((each for each in seen.clients if "rcl_interfaces/" not in each.type), key=lambda each: each.name)
    strange = [each.name for each in asked if each.name not in SIGNS]
    if strange:
        offered = ", ".join(SIGNS)
        return Cause(
            "wrong service name",
            f"the client asks for {' and '.join(strange)}, which nobody offers: our server has {offered}",
            "\n".join(_renamed(seen.trace, name, missing) for name in strange),
        )
    typed = next((each for each in asked if each.name in missing and each.type != TYPE), None)
    return _of_type(seen.trace, typed) if typed else None


def _renamed(trace: Trace, name: str, missing: Sequence[str], create: str = "create_client") -> str:
    """The step that makes the client ask for one of the missing services, or for none where it has them all."""
    texts = [each for each in source.nodes(trace) if isinstance(each, ast.Constant) and isinstance(each.value, str)]
    last = name.rpartition("/")[2]
    written = [each for each in texts if _last(each) == last]
    lines = ", ".join(map(str, sorted({each.lineno for each in written})))
    if len(joined := _joined(last)) > 1:
        where = f"line {lines}: " if written else ""
        return f"{where}write a comma after {joined[0]!r}: without it, Python joins it to {joined[1]!r}"
    if f"/{last}" in SIGNS and written:
        wrong = str(written[0].value)
        right = last if wrong != last else f"/{last}"
        return f"line {lines}: write {right!r} instead of {wrong!r}, since its name is /{last}"
    free = [each for each in missing if each[1:] not in map(_last, texts)]
    if not free:
        return f"take the client for {name} out{f': line {lines}' if lines else ''}"
    nearest = min(free, key=lambda each: -difflib.SequenceMatcher(None, name, each).ratio())
    if not written:
        return f"give {create} the name {nearest[1:]!r} in place of {name!r}"
    return f"line {lines}: write {nearest[1:]!r} instead of {written[0].value!r}"


def _joined(name: str) -> list[str]:
    """The services' names that this one is put together from, as Python does with two strings and no comma between."""
    one = "|".join(each[1:] for each in SIGNS)
    return re.findall(one, name) if re.fullmatch(f"(?:{one})+", name) else []


def _last(text: ast.Constant) -> str:
    return str(text.value).rpartition("/")[2]


def of_server(trace: Trace, offered: str, missing: str) -> str:
    """The step for a server that offers one name in place of another, by the line with the name if there is one."""
    plain = f"name it {missing[1:]!r}, without a namespace or ~ in front"
    found = _renamed(trace, offered, [missing], "create_service")
    return found if found.startswith("line ") else plain


def _of_type(trace: Trace, client: Service) -> Cause:
    wrong = client.type.rpartition("/")[2]
    lines = sorted({each.lineno for each in source.nodes(trace) if isinstance(each, ast.Name) and each.id == wrong})
    where = f" in place of {wrong} in line {', '.join(map(str, lines))}" if lines else ""
    return Cause(
        "wrong type",
        f"the client asks for {client.name} of the type {client.type}, our server offers it with {TYPE}",
        f"write AddTwoInts{where}, with from example_interfaces.srv import AddTwoInts at the top; a request is "
        "AddTwoInts.Request(a=8, b=2)",
    )
