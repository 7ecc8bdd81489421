"""I1.3: a client that asks for what our servers do not offer, in the words of its source."""

from __future__ import annotations

import ast
import difflib
from collections.abc import Sequence
from functools import partial

from checks.i1_3 import service_steps
from checks.i1_3.code import Code, learner_files, with_applicable_step
from checks.i1_3.facts import SIGNS, TYPE, ClientRun
from checks.i1_3.services import Changes
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause
from tutor.ros_model import ServiceEndpoint


def diagnose_client(seen: ClientRun, missing: Sequence[str]) -> Cause | None:
    """Whether a service client asks for a name, or a type, that none of our services has; some are `missing` calls."""
    if seen.trace is None or not missing:
        return None
    asked = sorted((each for each in seen.clients if not each.is_standard), key=lambda each: each.name)
    strange = [each.name for each in asked if each.name not in SIGNS]
    if strange:
        offered = ", ".join(SIGNS)
        return Cause(
            "wrong service name",
            f"the client asks for {' and '.join(strange)}, which nobody offers: our server has {offered}",
            _step(seen.trace, strange, missing),
        )
    typed = next((each for each in asked if each.name in missing and each.type != TYPE), None)
    return _diagnose_type(seen.trace, typed) if typed else None


def _step(trace: Trace, strange: Sequence[str], missing: Sequence[str]) -> str:
    """The step that makes the client ask for the missing services, and for none where it has them all."""
    texts = {each.value for code in learner_files(trace) for each in code.nodes if isinstance(each, ast.Constant)}
    free = [each for each in missing if each[1:] not in texts or any(name.endswith(each) for name in strange)]
    wanted = []
    for name in strange:
        like = [each for each in free if each == f"/{name.rpartition('/')[2]}"] or free
        nearest = max(like, key=lambda each: difflib.SequenceMatcher(None, name, each).ratio(), default="")
        if nearest:
            wanted.append((name, nearest))
            free.remove(nearest)
    return (
        service_steps.rename_services(trace, wanted, "create_client")
        or f"write {missing[0][1:]!r} in place of {strange[0]!r}"
    )


def _diagnose_type(trace: Trace, client: ServiceEndpoint) -> Cause:
    wrong = client.type.rpartition("/")[2]
    cause = Cause(
        "wrong type",
        f"the client asks for {client.name} of the type {client.type}, our server offers it with {TYPE}",
        f"write AddTwoInts in place of {wrong}, with from example_interfaces.srv import AddTwoInts at the top; a "
        "request is AddTwoInts.Request(a=8, b=2)",
    )
    return with_applicable_step(cause, trace, *(partial(_typed, code, wrong) for code in learner_files(trace)))


def _typed(code: Code, wrong: str) -> str | None:
    """The step that writes AddTwoInts wherever another type stands, with a request that it has."""
    local = code.imported(wrong)
    change = Changes(code, more=code.importing("AddTwoInts"))
    requests = [call for call in code.calls("Request") if ast.unparse(call.func) == f"{local}.Request"]
    change.swaps += [(call, "AddTwoInts.Request(a=8, b=2)") for call in requests]
    inside = {id(each) for call in requests for each in ast.walk(call)}
    names = [each for each in code.nodes if isinstance(each, ast.Name) and each.id == local and id(each) not in inside]
    change.swaps += [(each, "AddTwoInts") for each in names]
    return change.as_step() if change.swaps else None
