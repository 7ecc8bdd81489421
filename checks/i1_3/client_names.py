"""I1.3: diagnosis of a client that asks for a service name or type that our servers do not offer."""

from __future__ import annotations

import ast
import difflib
from collections.abc import Sequence
from functools import partial

from checks.i1_3 import service_steps
from checks.i1_3.code import Code, learner_files, with_applicable_step
from checks.i1_3.facts import OPERATOR_SIGNS, TYPE, ClientRun
from checks.i1_3.services import Changes
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause
from tutor.ros_model import ServiceEndpoint


def diagnose_client(seen: ClientRun, missing: Sequence[str]) -> Cause | None:
    """Diagnose a service client whose name or type none of our services has.

    `missing`: the services without a call; None if there are none.
    """
    if seen.trace is None or not missing:
        return None
    clients = sorted((each for each in seen.clients if not each.is_standard), key=lambda each: each.name)
    unknown = [each.name for each in clients if each.name not in OPERATOR_SIGNS]
    if unknown:
        offered = ", ".join(OPERATOR_SIGNS)
        return Cause(
            "wrong service name",
            f"the client asks for {' and '.join(unknown)}, which nobody offers: our server has {offered}",
            _rename_clients(seen.trace, unknown, missing),
        )
    mistyped = next((each for each in clients if each.name in missing and each.type != TYPE), None)
    return _diagnose_type(seen.trace, mistyped) if mistyped else None


def _rename_clients(trace: Trace, unknown: Sequence[str], missing: Sequence[str]) -> str:
    """Step: replace each unknown service name by the most similar missing one that is still free."""
    texts = {each.value for code in learner_files(trace) for each in code.nodes if isinstance(each, ast.Constant)}
    free = [each for each in missing if each[1:] not in texts or any(name.endswith(each) for name in unknown)]
    renames = []
    for name in unknown:
        candidates = [each for each in free if each == f"/{name.rpartition('/')[2]}"] or free
        nearest = max(candidates, key=lambda each: difflib.SequenceMatcher(None, name, each).ratio(), default="")
        if nearest:
            renames.append((name, nearest))
            free.remove(nearest)
    return (
        service_steps.rename_services(trace, renames, "create_client")
        or f"write {missing[0][1:]!r} in place of {unknown[0]!r}"
    )


def _diagnose_type(trace: Trace, client: ServiceEndpoint) -> Cause:
    wrong = client.type.rpartition("/")[2]
    cause = Cause(
        "wrong type",
        f"the client asks for {client.name} with type {client.type}, our server offers it with {TYPE}",
        f"write AddTwoInts in place of {wrong}, with from example_interfaces.srv import AddTwoInts at the top; a "
        "request is AddTwoInts.Request(a=8, b=2)",
    )
    return with_applicable_step(
        cause, trace, *(partial(_use_add_two_ints, code, wrong) for code in learner_files(trace))
    )


def _use_add_two_ints(code: Code, wrong: str) -> str | None:
    """Step: use AddTwoInts in place of the wrong type, with a request that fits it."""
    local = code.local_name(wrong)
    change = Changes(code, more=code.missing_imports("AddTwoInts"))
    requests = [call for call in code.calls("Request") if ast.unparse(call.func) == f"{local}.Request"]
    change.swaps += [(call, "AddTwoInts.Request(a=8, b=2)") for call in requests]
    inside = {id(each) for call in requests for each in ast.walk(call)}
    names = [each for each in code.nodes if isinstance(each, ast.Name) and each.id == local and id(each) not in inside]
    change.swaps += [(each, "AddTwoInts") for each in names]
    return change.as_step() if change.swaps else None
