"""I2.3: edits that rewrite the service, the timer and the main program of a learner's node.

Each function returns edits of the learner's own file that use its names; none if the file has no place for them.
"""

from __future__ import annotations

import ast
import textwrap
from itertools import pairwise

from checks.i2_3.facts import WORK_S
from checks.i2_3.ticks import HZ
from tutor.judge.edits import Edit, apply, insert_above, replace_node, replace_parameters, replace_statement
from tutor.judge.rewriting.node import NodeFile, argument, is_static, with_body
from tutor.judge.rewriting.program import whole_program
from tutor.judge.source import Function

_GROUP = "callback_group"
_REENTRANT = "ReentrantCallbackGroup"


def service(file: NodeFile) -> ast.Call | None:
    """The call that creates the service."""
    made = file.calls("create_service")
    named = [each for each in made if "slow_add" in ast.unparse(argument(each, 1, "srv_name") or each.func)]
    return next(iter(named or made), None)


def timer(file: NodeFile) -> ast.Call | None:
    """The call that creates the timer: of several, one whose callback logs, and of these, one with the right period."""
    made = [each for each in file.timers if argument(each, 1, "callback") is not None]
    logging = [each for each in made if (found := timer_callback(file, each)) and _logs(found)]
    right = [each for each in logging if number(each.args[0] if each.args else each) == 1 / HZ]
    return next(iter(right or logging or made), None)


def service_callback(file: NodeFile) -> Function | None:
    """The service's callback."""
    made = service(file)
    return file.function(argument(made, 2, "callback")) if made is not None else None


def timer_callback(file: NodeFile, made: ast.Call | None = None) -> Function | None:
    """The timer's callback."""
    made = made or timer(file)
    return file.function(argument(made, 1, "callback")) if made is not None else None


def rewrite_service_callback(file: NodeFile) -> list[Edit]:
    """Rewrite the whole service callback: it sleeps, and answers with the sum."""
    found, made = service_callback(file), service(file)
    sleep, imported = sleep_expression(file)
    if found is None:
        if made is None or file.setup is None or file.class_of(file.setup) is None:
            return []
        given = argument(made, 2, "callback")
        code = f"def add_slowly(self, request, response):\n{_indented(_work_code(sleep, 'request', 'response'))}"
        edits = [*imported, *file.new_method(code)]
        return [*edits, replace_node(file.text, given, "self.add_slowly")] if given is not None else edits
    names = [each.arg for each in found.args.args]
    is_method = file.class_of(found) is not None and not is_static(found)
    given = argument(made, 2, "callback") if made is not None else None
    binds_others = isinstance(given, ast.Lambda | ast.Call) and len(names) - is_method > 2  # such as partial(add, node)
    if (len(names) - is_method != 2 and not binds_others) or found.args.kwonlyargs:
        first = [*names[:1]] if is_method else []
        code = f"def {found.name}({', '.join([*first, 'request', 'response'])}):\n" + _indented(
            _work_code(sleep, "request", "response")
        )
        return [*imported, replace_statement(found, code)]
    return [*imported, with_body(found, _work_code(sleep, *names[-2:]))]


def _work_code(sleep: str, request: str, response: str) -> str:
    return f"{sleep}({WORK_S})\n{response}.sum = {request}.a + {request}.b\nreturn {response}"


def rewrite_service(file: NodeFile) -> list[Edit]:
    """Rewrite the call that creates the service: type, name, callback, and a reentrant callback group."""
    kind, imported = file.import_name("AddTwoInts", "example_interfaces.srv")
    group, group_import = file.import_name(_REENTRANT, "rclpy.callback_groups")
    made, found = service(file), service_callback(file)
    if made is None:
        first = _find_summing_function(file)
        if first is None:
            return []
        callback = f"self.{first.name}" if file.class_of(first) is not None else first.name
        code = f"{file.name}.create_service({kind}, '/slow_add', {callback}, {_GROUP}={group}())"
        return [*imported, *group_import, *file.append_to_setup(code)]
    given = argument(made, 2, "callback")
    callback = ast.unparse(given) if given is not None and found is not None else "self.add_slowly"
    code = f"{ast.unparse(made.func)}({kind}, '/slow_add', {callback}, {_GROUP}={group}())"
    return [*imported, *group_import, replace_node(file.text, made, code)]


def rewrite_timer(file: NodeFile) -> list[Edit]:
    """Rewrite the call that creates the timer: period, callback, and its own callback group."""
    group, group_import = file.import_name(_REENTRANT, "rclpy.callback_groups")
    made = timer(file)
    if made is None:
        return _new_timer(file, group, group_import)
    given = argument(made, 1, "callback")
    code = f"{ast.unparse(made.func)}({1 / HZ:g}, {ast.unparse(given or made)}, {_GROUP}={group}())"
    if is_made_in_each_call(file):
        return [*group_import, *file.append_to_setup(code)]
    return [*group_import, replace_node(file.text, made, code)]


def is_made_in_each_call(file: NodeFile) -> bool:
    """Whether the service callback creates the timer, so that each call creates another one."""
    made = timer(file)
    return (
        made is not None
        and file.function_around(made) is not None
        and file.function_around(made) is service_callback(file)
    )


def _new_timer(file: NodeFile, group: str, group_import: list[Edit]) -> list[Edit]:
    setup = file.setup
    if setup is None or file.class_of(setup) is None:
        return []
    existing = next((each for each in file.functions if each.name in ("tick", "on_tick", "timer_callback")), None)
    name = existing.name if existing is not None else "tick"
    lines = f"self.ticks = 0\nself.create_timer({1 / HZ:g}, self.{name}, {_GROUP}={group}())"
    edits = [*group_import, *file.append_to_setup(lines)]
    if existing is not None:
        return edits
    return [*edits, *file.new_method(f"def {name}(self):\n{_indented(_tick_code('self.ticks', 'self'))}")]


def rewrite_timer_callback(file: NodeFile) -> list[Edit]:
    """Rewrite the whole timer callback: it counts the ticks, and logs every tenth one's number."""
    found, made = timer_callback(file), timer(file)
    if found is None or made is None:
        return []
    if file.class_of(found) is None or not found.args.args:
        node = file.name if isinstance(found, ast.FunctionDef) else "node"
        return [with_body(found, f"{node}.get_logger().info('Tick')")]
    self_name = found.args.args[0].arg
    counter = _counter(found, self_name)
    statement = file.statement(made)
    setup = (
        []
        if counter and _is_initialised(file, counter, found)
        else [insert_above(statement.lineno, f"{counter or f'{self_name}.ticks'} = 0")]
    )
    is_passed = not isinstance(argument(made, 1, "callback"), ast.Lambda | ast.Call)
    return [
        *setup,
        # A callback of ROS 1 takes an event, too; what a lambda passes is kept.
        *(replace_parameters(file.text, found, [self_name]) if is_passed else []),
        with_body(found, _tick_code(counter or f"{self_name}.ticks", self_name)),
    ]


def _tick_code(counter: str, node: str) -> str:
    return f"{counter} += 1\nif {counter} % 10 == 0:\n    {node}.get_logger().info(f'Tick {{{counter}}}')"


def rewrite_program(file: NodeFile) -> list[Edit]:
    """Rewrite the main program: the executor has enough threads, and Ctrl+C ends it."""
    return whole_program(file, threads=True)


def combine_edits(file: NodeFile, *parts: list[Edit]) -> list[Edit]:
    """Merge the edits of several parts, dropping duplicates and those without effect; none at all if two overlap."""
    edits = dict.fromkeys(each for part in parts for each in part)
    found = [each for each in edits if apply(file.text, [each]).split() != file.text.split()]
    lines = sorted((each.first, each.last) for each in found if each.last >= each.first)
    return [] if any(first <= last for (_, last), (first, _) in pairwise(lines)) else found


def sleep_expression(file: NodeFile) -> tuple[str, list[Edit]]:
    """The file's expression for time.sleep, and the import if it is missing."""
    name, edits = file.import_name("sleep", "time")
    taken = {node.id for node in ast.walk(file.tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    taken |= {alias.asname or alias.name for _, alias in file.imports}
    if name == "sleep" and edits and "time" not in taken:
        return "time.sleep", [Edit(edits[0].first, edits[0].last, "import time", like=edits[0].like)]
    return name, edits


def _find_summing_function(file: NodeFile) -> Function | None:
    """A function that may be meant as the service callback, in a file that creates no service."""
    return next((each for each in file.functions if len(each.args.args) >= 2 and "sum" in ast.unparse(each)), None)


def _logs(function: Function) -> bool:
    return any(isinstance(each, ast.Attribute) and each.attr == "get_logger" for each in ast.walk(function))


def _counter(function: Function, self_name: str) -> str:
    """The attribute of the node that counts the ticks, or ""."""
    for each in ast.walk(function):
        if isinstance(each, ast.AugAssign) and isinstance(each.op, ast.Add):
            target = ast.unparse(each.target)
            if target.startswith(f"{self_name}."):
                return target
    return ""


def _is_initialised(file: NodeFile, counter: str, callback: Function) -> bool:
    """Whether the counter is initialised with a constant outside the timer callback."""
    return any(
        isinstance(each, ast.Assign | ast.AnnAssign)
        and ast.unparse(each.targets[0] if isinstance(each, ast.Assign) else each.target) == counter
        and isinstance(each.value, ast.Constant)
        and file.function_around(each) is not callback
        for each in ast.walk(file.tree)
    )


def _indented(code: str) -> str:
    return textwrap.indent(code, "    ")


def number(expression: ast.expr) -> float | None:
    """The value of a number, or of a quotient of two."""
    match expression:
        case ast.Constant(value=int() | float() as value):
            return float(value)
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            one, other = number(left), number(right)
            return one / other if one is not None and other else None
    return None
