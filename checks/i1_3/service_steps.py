"""I1.3: edits of the server's code that bring a service about: its name, its type, its answer."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from checks.i1_3.code import Code, learner_files
from checks.i1_3.facts import SIGNS
from checks.i1_3.services import Changes, argument_names, compute_results, find_callback, find_offer, new_callback
from tutor.judge import edits, source
from tutor.judge.edits import Edit
from tutor.judge.rewriting.node import argument
from tutor.judge.source import Function
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause


def add_services(trace: Trace, missing: Sequence[str]) -> str | None:
    """The step that offers the services that are missing, below the others, or where the node is made."""
    for code in learner_files(trace):
        place = _place(code)
        if place is None:
            continue
        at, node = place
        kind = next(
            (ast.unparse(each) for call in code.calls("create_service") if (each := argument(call, 0, "srv_type"))), ""
        )
        kind = kind if kind.isidentifier() else code.imported("AddTwoInts")
        lines, defined = [], []
        for service in missing:
            has = [each for each in code.functions if each.name in (service[1:], f"{service[1:]}_callback")]
            if len(has) == 1 and len(argument_names(code, has[0])) == 2 and code.self_name(at):
                name = f"{code.self_name(at)}.{has[0].name}"
            else:
                name, edit = new_callback(code, at, service)
                defined.append(edit.code.rstrip() + "\n\n")
            lines.append(f"{node}.create_service({kind}, '{service[1:]}', {name})")
        above = [edits.insert_above(_top(code, at), "".join(defined))] if defined and code.self_name(at) else []
        written = "".join([*([] if code.self_name(at) else defined), "\n".join(lines)])
        below = edits.insert_after(at, written)
        imports = code.importing("AddTwoInts") if kind == "AddTwoInts" else []
        if (step := code.as_step(imports, above, below)) is not None:
            return step
    return None


def diagnose_destroyed(trace: Trace) -> Cause | None:
    """Whether a service is destroyed with an object that holds it: as soon as nothing refers to that any more."""
    for code in learner_files(trace):
        for call in code.calls("destroy_service"):
            function = code.function_around(call)
            if function is not None and function.name == "__del__":
                step = code.as_step([edits.remove_statement(code.text, function)])
                text = (
                    f"line {call.lineno}: __del__ destroys the service when nothing refers to the object any more, as "
                    "when its variable is assigned again"
                )
                return Cause("service destroyed", text, step) if step else None
    return None


def _place(code: Code) -> tuple[ast.stmt, str] | None:
    """The statement below which a service can be offered, and what the node is called there."""
    if made := code.calls("create_service"):
        around = code.class_of(made[-1])
        if around is not None and around.name not in code.node_classes:  # a class of the learner's own for a service
            return None
        return code.outermost(made[-1]), code.node(made[-1])
    for call in code.calls("__init__", "create_node", "Node", *code.node_classes):
        statement = code.outermost(call)
        if source.called_name(call) == "__init__" and code.self_name(call):
            return statement, code.self_name(call)
        if source.called_name(call) != "__init__" and isinstance(statement, ast.Assign):
            return statement, ast.unparse(statement.targets[0])
    return None


def _top(code: Code, at: ast.stmt) -> int:
    function = [each for each in code.ancestors(at) if isinstance(each, Function)][-1]
    return min([function.lineno, *(each.lineno for each in function.decorator_list)])


def rename_services(trace: Trace, wanted: Sequence[tuple[str, str]], create: str = "create_service") -> str | None:
    """The step by which each of these (name as it is in the graph, name as it must be) gets its name."""
    for code in learner_files(trace) if wanted else ():
        change = Changes(code)
        for call in code.calls(create):
            name = argument(call, 1, "srv_name")
            if (
                name is not None
                and not isinstance(name, ast.Constant)
                and all(is_.endswith(must) for is_, must in wanted)
            ):
                plain = isinstance(name, ast.Name | ast.Attribute | ast.Subscript | ast.Call)
                text = ast.unparse(name) if plain else f"({ast.unparse(name)})"
                change.swaps.append((name, f"'/' + {text}.rpartition('/')[2]"))
        computed = bool(change.swaps)
        for is_, must in wanted:
            texts = [each for each in code.nodes if isinstance(each, ast.Constant) and isinstance(each.value, str)]
            for each in texts if not computed else []:
                if str(each.value).rpartition("/")[2] == is_.rpartition("/")[2] and not _spoken(code, each):
                    parts = re.findall("|".join(name[1:] for name in SIGNS), str(each.value))
                    joined = len(parts) > 1 and "".join(parts) == each.value  # as Python does without a comma
                    right = must if str(each.value) == must[1:] else must[1:]
                    change.swaps.append((each, ", ".join(map(repr, parts if joined else [right]))))
        if change.swaps and (step := change.as_step()) is not None:
            return step
    return None


def _spoken(code: Code, text: ast.Constant) -> bool:
    """Whether a text is an f-string's, or said to a human."""
    return isinstance(next(code.ancestors(text), None), ast.JoinedStr | ast.Expr)


def set_types(trace: Trace, wrong: Sequence[str]) -> str | None:
    """The step that gives services the type AddTwoInts, and callbacks that fill in a sum."""
    there = find_offer(trace, wrong[0])
    if there is None:
        return None
    code, kind = there.code, there.code.imported("AddTwoInts")
    change = Changes(code, more=code.importing("AddTwoInts"))
    for call in code.calls("create_service"):
        given_one = argument(call, 0, "srv_type")
        if given_one is not None and ast.unparse(given_one) != kind:
            change.swaps.append((given_one, kind))
    return compute_results(trace, wrong, whole=True, change=change)


def use_default_qos(code: Code) -> str | None:
    """The step that leaves the QoS profile of services, and of their clients, at its default."""
    change = Changes(code)
    for call in code.calls("create_service", "create_client"):
        kept = [each for each in call.keywords if each.arg != "qos_profile"]
        if len(kept) < len(call.keywords):
            change.swaps.append((call, ast.unparse(ast.Call(call.func, call.args, kept))))
    return change.as_step() if change.swaps else None


def return_response(trace: Trace, service: str) -> str | None:
    """The step that lets a callback return its response on every path: its own, or that of what is around it."""
    found = find_callback(trace, service)
    if found is None:
        return compute_results(trace, [service], whole=True)
    code, function = found
    for each in (function, *_wrappers(code, function), *_helpers(code, function)):
        changes = list(_returns(code, each, argument_names(code, function)[1]))
        if changes and (step := code.as_step(changes)) is not None:
            return step
    return compute_results(trace, [service], whole=True)


def _wrappers(code: Code, function: Function) -> Iterator[Function]:
    """The functions that decorators put around this one."""
    names = {
        source.called_name(each) if isinstance(each, ast.Call) else ast.unparse(each)
        for each in function.decorator_list
    }
    for outer in (each for name in sorted(names) for each in code.named(name)):
        inner = [each for each in ast.walk(outer) if isinstance(each, Function) and each is not outer]
        yield from reversed(inner)


def _helpers(code: Code, function: Function) -> Iterator[Function]:
    """The functions whose result this one returns."""
    for each in ast.walk(function):
        if isinstance(each, ast.Return) and isinstance(each.value, ast.Call):
            yield from code.named(source.called_name(each.value))


def _returns(code: Code, function: Function, usual: str) -> Iterator[Edit]:
    names = argument_names(code, function)
    response = usual if usual in names or not names else names[-1]
    for each in ast.walk(function):
        if (
            isinstance(each, ast.Assign)
            and isinstance(each.targets[0], ast.Attribute)
            and each.targets[0].attr == "sum"
        ):
            response = ast.unparse(each.targets[0].value)
    if function.args.vararg is not None and not names:
        call = next((e for e in function.body if isinstance(e, ast.Expr) and isinstance(e.value, ast.Call)), None)
        if call is not None and (missing := edits.return_on_every_path(function, "result")):
            yield edits.replace_node(code.text, call.value, f"result = {ast.unparse(call.value)}")
            yield from missing
        return
    yield from edits.return_on_every_path(function, response)
    for each in ast.walk(function):
        if isinstance(each, ast.Return) and code.function_around(each) is function:
            value = each.value
            none = value is None or ast.unparse(value) == "None"
            if (
                value is not None
                and not none
                and not isinstance(value, ast.Call)
                and not _given(function, value, response)
            ):
                sums = [] if f"{response}.sum" == ast.unparse(value) else [f"{response}.sum = {ast.unparse(value)}"]
                yield edits.replace_statement(each, "\n".join([*sums, f"return {response}"]))


def _given(function: Function, value: ast.expr, response: str) -> bool:
    """Whether what is returned may well be a response: it is called so, or is a variable of the function's own."""
    made = {ast.unparse(each.targets[0]) for each in ast.walk(function) if isinstance(each, ast.Assign)}
    return ast.unparse(value) in (response, *made)
