"""Executors: which nodes they serve, and which they never get to."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found, found, mistake
from tutor.mistakes.themes.spinning import EXECUTORS
from tutor.source import NodeFile, called_name, calls_in, last_name, values_of

_NODE_LISTS = tuple(f"self._{kind}" for kind in ("timers", "subscriptions", "services", "clients", "guards"))
_UNSERVED = (
    Symptom.NO_ANSWER,
    Symptom.NO_MESSAGES,
    Symptom.NOTHING_RECEIVED,
    Symptom.WRONG_ANSWER,
    Symptom.CALLS_MISSING,
    Symptom.STANDS_STILL,
    Symptom.NOT_LOGGED,
)


@mistake(
    "attribute-of-node-overwritten",
    explains=(*_UNSERVED, Symptom.SERVICE_MISSING, Symptom.WRONG_RATE),
    says="{line} overwrites {name}, in which rclpy's Node keeps what it has to serve: {code}",
    do="Give the attribute another name.",
)
def overwritten_attribute(case: Case) -> Iterator[Found]:
    """A node overwrites an attribute of rclpy's Node.

    Names that begin with an underscore belong to the base class. Node keeps its timers, subscriptions, services and
    clients in lists with such names, and an executor looks there for what it has to serve.

    Bad:

        class Doorbell(Node):
            def __init__(self):
                super().__init__('doorbell')
                self._timers = {}

    Good:

        class Doorbell(Node):
            def __init__(self):
                super().__init__('doorbell')
                self.my_timers = {}

    See it: the callbacks are never called, though everything is in the graph.
    """
    for file in case.files:
        for node in file.nodes:
            if isinstance(node, ast.Assign | ast.AnnAssign) and file.node_method(node) is not None:
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                for name in map(ast.unparse, targets):
                    if name in _NODE_LISTS:
                        yield found(file, node, name=name)


@mistake(
    "another-node-spun",
    explains=_UNSERVED,
    says="{line} runs the callbacks of {spun}, not those of {other}: {code}",
    do="Let one executor spin all nodes that have callbacks.",
)
def another_node_spun(case: Case) -> Iterator[Found]:
    """One node is spun, but another has the callbacks.

    rclpy.spin(node) serves that one node. Any other node of the program is in the graph, but does nothing unless it is
    added to an executor that spins.

    Bad:

        class Bell(Node):
            def __init__(self):
                super().__init__('bell')
                self.create_timer(1.0, self.ring)

        def main():
            helper = rclpy.create_node('helper')
            bell = Bell()
            rclpy.spin(helper)

    Good:

        class Bell(Node):
            def __init__(self):
                super().__init__('bell')
                self.create_timer(1.0, self.ring)

        def main():
            bell = Bell()
            rclpy.spin(bell)

    See it: `ros2 param list` answers for one node only.
    """
    for file in case.files:
        yield from _other_spun(file)
    yield from _inner_node(case)


def _other_spun(file: NodeFile) -> Iterator[Found]:
    spins = [call for call in file.calls("spin") if len(call.args) == 1 and isinstance(call.args[0], ast.Name)]
    if len(spins) != 1 or file.calls("add_node") or not isinstance(file.statement(spins[0]), ast.Expr):
        return
    function, spun = file.function_around(spins[0]), ast.unparse(spins[0].args[0])
    made = [call for call in file.calls(*file.node_classes) if _has_callbacks(file, call)]
    nodes = [file.assigned_to(call) for call in made if file.function_around(call) is function]
    left_out = [node for node in nodes if node != spun]
    helpers = {file.assigned_to(call) for call in file.calls("create_node", "Node")}
    if left_out and "" not in nodes and (spun in nodes or spun in helpers):
        yield found(file, spins[0], spun=spun, other=" and ".join(left_out))


def _inner_node(case: Case) -> Iterator[Found]:
    """A node that creates another one, where only the outer one is spun."""
    nodes = {name for file in case.files for name in file.node_classes}
    spins = ("add_node", "spin", "spin_once", "spin_until_future_complete")
    served = {name for file in case.files for call in file.calls(*spins) for name in _meant(file, call)}
    for file in case.files:
        for call in file.calls(*nodes):
            outer, inner = file.class_of(call), file.assigned_to(call)
            if outer is None or outer.name not in nodes or not inner.startswith("self.") or inner[5:] in served:
                continue
            if any(_has_callbacks(source, call) for source in case.files):
                yield found(file, call, spun=outer.name, other=called_name(call))


def _meant(file: NodeFile, call: ast.Call) -> Iterator[str]:
    """The names by which a call's arguments are known: their own, and those that they or their loops are given."""
    for given in call.args:
        loops = [loop for loop in file.ancestors(call) if isinstance(loop, ast.For)]
        values = [*values_of(ast.unparse(given), file.tree), *(loop.iter for loop in loops)]
        values += [value for loop in loops for value in values_of(ast.unparse(loop.iter), file.tree)]
        for expression in (given, *values):
            yield from (last_name(node) for node in ast.walk(expression))


def _has_callbacks(file: NodeFile, made: ast.Call) -> bool:
    """Whether the class of this node creates anything that an executor has to serve."""
    creators = ("create_subscription", "create_timer", "create_service", "create_client")
    return any(
        bool(calls_in(node, *creators))
        for node in file.nodes
        if isinstance(node, ast.ClassDef) and node.name == called_name(made)
    )


@mistake(
    "node-taken-from-its-executor",
    explains=_UNSERVED,
    says="{line} moves the node to another executor, and so takes it out of {executor}: {code}",
    do="Let {executor} do this spin as well.",
)
def node_taken(case: Case) -> Iterator[Found]:
    """rclpy.spin_once() takes a node out of its executor.

    A node is in one executor at a time. rclpy.spin_once(node) and rclpy.spin_until_future_complete(node, …) add it to
    the global executor, which takes it out of the one it was in before.

    Bad:

        executor.add_node(bell)
        rclpy.spin_once(bell)
        executor.spin()

    Good:

        executor.add_node(bell)
        executor.spin_once()
        executor.spin()

    See it: nothing happens after the first call.
    """
    for file in case.files:
        owners = {
            ast.unparse(call.args[0]): call
            for call in file.calls("add_node")
            if len(call.args) == 1 and isinstance(call.func, ast.Attribute)
        }
        for call in file.calls("spin_once", "spin_until_future_complete"):
            added = owners.get(ast.unparse(call.args[0])) if call.args else None
            if added is None or added.lineno > call.lineno:
                continue
            if file.function_around(added) is file.function_around(call) and isinstance(added.func, ast.Attribute):
                yield found(file, call, executor=ast.unparse(added.func.value))


@mistake(
    "second-spin",
    explains=_UNSERVED,
    says="{line} {reached}, because line {first} spins until the program ends: {code}",
    do="Add all nodes to one executor, and spin it once.",
)
def second_spin(case: Case) -> Iterator[Found]:
    """One spin comes after another.

    spin() does not return until the program is to end. A second one below it, or the next round of a loop around it, is
    never reached.

    Bad:

        rclpy.spin(bell)
        rclpy.spin(door)

    Good:

        executor.add_node(bell)
        executor.add_node(door)
        executor.spin()

    See it: only the first node answers `ros2 param list`.
    """
    for file in case.files:
        spins = [call for call in file.calls("spin") if isinstance(file.statement(call), ast.Expr)]
        for first in spins:
            block = file.block_of(file.statement(first))
            for later in spins:
                below = file.statement(later) in block and later.lineno > first.lineno
                if below and ast.unparse(later) != ast.unparse(first):
                    yield found(file, later, reached="is never reached", first=first.lineno)
        for loop in (node for node in file.nodes if isinstance(node, ast.For)):
            for call in spins:
                if file.statement(call) in loop.body:
                    yield found(file, call, reached="is not reached a second time", first=call.lineno)


@mistake(
    "another-executor-for-each-node",
    explains=_UNSERVED,
    says="{line} makes an executor for each node, but line {spin} spins only the last: {code}",
    do="Make one executor, above the loop.",
)
def executor_for_each(case: Case) -> Iterator[Found]:
    """A loop makes an executor for each node.

    Each executor serves the nodes that were added to it. If the loop makes a new one each time, the one that is spun
    afterwards has only the last node.

    Bad:

        for node in nodes:
            executor = SingleThreadedExecutor()
            executor.add_node(node)
        executor.spin()

    Good:

        executor = SingleThreadedExecutor()
        for node in nodes:
            executor.add_node(node)
        executor.spin()

    See it: only the last node answers `ros2 param list`.
    """
    for file in case.files:
        for loop in (node for node in file.nodes if isinstance(node, ast.For)):
            for made in calls_in(loop, *EXECUTORS):
                name = file.assigned_to(made)
                added = [call for call in calls_in(loop, "add_node") if ast.unparse(call.func) == f"{name}.add_node"]
                spun = [call for call in file.calls("spin") if ast.unparse(call.func) == f"{name}.spin"]
                if added and spun and not any(call in ast.walk(loop) for call in spun):
                    yield found(file, made, spin=spun[0].lineno)
