"""I1.3: steps that give the server a service: one that is there, with the right name and type, and that answers."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from checks.i1_3.code import Code, learner_files
from checks.i1_3.facts import OPERATOR_SIGNS
from checks.i1_3.services import Changes, argument_names, compute_results, find_callback, find_offer, new_callback
from tutor.judge import edits, source
from tutor.judge.causes.topics import use_default_service_qos
from tutor.judge.edits import Edit
from tutor.judge.exceptions.callback_rewriting import instances
from tutor.judge.rewriting.node import argument
from tutor.judge.source import Function
from tutor.judge.trace import Trace
from tutor.judge.verdict import Cause


def add_services(trace: Trace, missing: Sequence[str]) -> str | None:
    """Step: offer the missing services, below the existing ones or where the node is created."""
    for code in learner_files(trace):
        place = _find_place(code)
        if place is None:
            continue
        at, node = place
        srv_type = next(
            (ast.unparse(each) for call in code.calls("create_service") if (each := argument(call, 0, "srv_type"))), ""
        )
        srv_type = srv_type if srv_type.isidentifier() else code.local_name("AddTwoInts")
        lines, new_functions = [], []
        for service in missing:
            present = [each for each in code.functions if each.name in (service[1:], f"{service[1:]}_callback")]
            if len(present) == 1 and len(argument_names(code, present[0])) == 2 and code.self_name(at):
                name = f"{code.self_name(at)}.{present[0].name}"
            else:
                name, edit = new_callback(code, at, service)
                new_functions.append(edit.code.rstrip() + "\n\n")
            lines.append(f"{node}.create_service({srv_type}, '{service[1:]}', {name})")
        in_method = bool(code.self_name(at))
        above = (
            [edits.insert_above(_first_line(code, at), "".join(new_functions))] if new_functions and in_method else []
        )
        below = edits.insert_after(at, "".join([*([] if in_method else new_functions), "\n".join(lines)]))
        imports = code.missing_imports("AddTwoInts") if srv_type == "AddTwoInts" else []
        if (step := code.as_step(imports, above, below)) is not None:
            return step
    return None


def diagnose_destroyed(trace: Trace) -> Cause | None:
    """Diagnose a `__del__` that destroys a service as soon as nothing refers to the object that holds it."""
    for code in learner_files(trace):
        for call in code.calls("destroy_service"):
            function = code.function_around(call)
            if function is not None and function.name == "__del__":
                step = code.as_step([edits.remove_statement(code.text, function)])
                text = (
                    f"line {call.lineno}: __del__ destroys the service when nothing refers to the object any more, "
                    "for example when its variable is reassigned"
                )
                return Cause("service destroyed", text, step) if step else None
    return None


def _find_place(code: Code) -> tuple[ast.stmt, str] | None:
    """Find the statement below which to create a service, and the variable that holds the node there."""
    if made := code.calls("create_service"):
        owner = code.class_of(made[-1])
        if owner is not None and owner.name not in code.node_classes:  # the learner wraps each service in a class
            return None
        return code.outermost_statement(made[-1]), code.node_name(made[-1])
    for call in code.calls("__init__", "create_node", "Node", *code.node_classes):
        statement = code.outermost_statement(call)
        if source.called_name(call) == "__init__" and code.self_name(call):
            return statement, code.self_name(call)
        if source.called_name(call) != "__init__" and isinstance(statement, ast.Assign):
            return statement, ast.unparse(statement.targets[0])
    return None


def _first_line(code: Code, at: ast.stmt) -> int:
    """The first line of the outermost function around a statement, decorators included."""
    function = [each for each in code.ancestors(at) if isinstance(each, Function)][-1]
    return min([function.lineno, *(each.lineno for each in function.decorator_list)])


def rename_services(trace: Trace, wanted: Sequence[tuple[str, str]], create: str = "create_service") -> str | None:
    """Step: rename services; `wanted` pairs each name in the graph with the required one."""
    for code in learner_files(trace) if wanted else ():
        change = Changes(code)
        for call in code.calls(create):
            name = argument(call, 1, "srv_name")
            if (
                name is not None
                and not isinstance(name, ast.Constant)
                and all(actual.endswith(required) for actual, required in wanted)
            ):
                plain = isinstance(name, ast.Name | ast.Attribute | ast.Subscript | ast.Call)
                text = ast.unparse(name) if plain else f"({ast.unparse(name)})"
                change.swaps.append((name, f"'/' + {text}.rpartition('/')[2]"))
        names_are_computed = bool(change.swaps)
        for actual, required in wanted:
            texts = [each for each in code.nodes if isinstance(each, ast.Constant) and isinstance(each.value, str)]
            for each in texts if not names_are_computed else []:
                if str(each.value).rpartition("/")[2] == actual.rpartition("/")[2] and not _is_prose(code, each):
                    parts = re.findall("|".join(name[1:] for name in OPERATOR_SIGNS), str(each.value))
                    # Python joins adjacent literals if the comma between them is missing: 'add' 'subtract'.
                    joined = len(parts) > 1 and "".join(parts) == each.value
                    replacement = required if str(each.value) == required[1:] else required[1:]
                    change.swaps.append((each, ", ".join(map(repr, parts if joined else [replacement]))))
        if change.swaps and (step := change.as_step()) is not None:
            return step
    return None


def _is_prose(code: Code, text: ast.Constant) -> bool:
    """Whether a string is part of an f-string, or a docstring."""
    return isinstance(next(code.ancestors(text), None), ast.JoinedStr | ast.Expr)


def set_types(trace: Trace, wrong: Sequence[str]) -> str | None:
    """Step: give services the type AddTwoInts, and callbacks that set `sum`."""
    offer = find_offer(trace, wrong[0])
    if offer is None:
        return None
    code, required = offer.code, offer.code.local_name("AddTwoInts")
    change = Changes(code, more=code.missing_imports("AddTwoInts"))
    for call in code.calls("create_service"):
        srv_type = argument(call, 0, "srv_type")
        if srv_type is not None and ast.unparse(srv_type) != required:
            change.swaps.append((srv_type, required))
    return compute_results(trace, wrong, whole=True, change=change)


def use_default_qos(code: Code) -> str | None:
    """Step: leave the QoS profile of services and service clients at its default."""
    return code.as_step(use_default_service_qos(code))


def return_response(trace: Trace, service: str) -> str | None:
    """Step: return the response on every path through a decorator of the callback, the callback, or a helper.

    If it is the callback that does not return it, the other services' callbacks in its file return theirs, too.
    """
    found = find_callback(trace, service)
    for code in learner_files(trace):
        if (step := code.as_step(instances(code.text, {}) or _return_response_alone(code))) is not None:
            return step
    if found is None:
        return compute_results(trace, [service], whole=True)
    code, function = found
    for each in (*_wrappers(code, function), function, *_helpers(code, function)):
        changes = list(_fix_returns(code, each, argument_names(code, function)[1]))
        if changes and each is function:
            changes = _fix_all_returns(trace, code)
        if changes and (step := code.as_step(changes)) is not None:
            return step
    return compute_results(trace, [service], whole=True)


def _return_response_alone(code: Code) -> list[Edit]:
    """Return the response alone where it is returned in a tuple, as in `return False, response`."""
    tuples = []
    for function in code.functions:
        last = [each.arg for each in function.args.args][-1:]
        for each in ast.walk(function):
            if isinstance(each, ast.Return) and isinstance(each.value, ast.Tuple):
                tuples += [
                    (each, name.id) for name in each.value.elts if isinstance(name, ast.Name) and [name.id] == last
                ]
    return [edits.replace_statement(each, f"return {name}") for each, name in reversed(tuples)]


def _fix_all_returns(trace: Trace, code: Code) -> list[Edit]:
    """Make all callbacks in this file return their responses, the lowest edit first."""
    found = [each for service in OPERATOR_SIGNS if (each := find_callback(trace, service)) is not None]
    functions = {function.lineno: function for there, function in found if there.file == code.file}
    changes = [edit for each in functions.values() for edit in _fix_returns(code, each, argument_names(code, each)[1])]
    return sorted(changes, key=lambda edit: -edit.first)


def _wrappers(code: Code, function: Function) -> Iterator[Function]:
    """The inner functions that decorators wrap around this one."""
    names = {
        source.called_name(each) if isinstance(each, ast.Call) else ast.unparse(each)
        for each in function.decorator_list
    }
    for outer in (each for name in sorted(names) for each in code.functions_named(name)):
        inner = [each for each in ast.walk(outer) if isinstance(each, Function) and each is not outer]
        yield from reversed(inner)


def _helpers(code: Code, function: Function) -> Iterator[Function]:
    """The functions whose result this one returns."""
    for each in ast.walk(function):
        if isinstance(each, ast.Return) and isinstance(each.value, ast.Call):
            yield from code.functions_named(source.called_name(each.value))


def _fix_returns(code: Code, function: Function, usual: str) -> Iterator[Edit]:
    """Yield edits that make a function return its response, `usual` being the response's usual name."""
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
            if (
                value is not None
                and ast.unparse(value) != "None"
                and not isinstance(value, ast.Call)
                and not _may_be_response(function, value, response)
            ):
                sums = [] if f"{response}.sum" == ast.unparse(value) else [f"{response}.sum = {ast.unparse(value)}"]
                yield edits.replace_statement(each, "\n".join([*sums, f"return {response}"]))


def _may_be_response(function: Function, value: ast.expr, response: str) -> bool:
    """Whether a returned value may be a response: it has the response's name, or is a local variable."""
    local = {ast.unparse(each.targets[0]) for each in ast.walk(function) if isinstance(each, ast.Assign)}
    return ast.unparse(value) in (response, *local)
