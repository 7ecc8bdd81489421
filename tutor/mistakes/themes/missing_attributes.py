"""Exceptions about attributes that the class itself explains: the order of its lines, its parents, its names."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.exceptions import EXPLAINED, RaisedException, found_in, from_example, raised_in
from tutor.mistakes.exceptions.known import Example
from tutor.source import NodeFile, calls_in

_MISSING = re.compile(r"'(?P<owner>\w+)' object has no attribute '(?P<name>\w+)'")
_NODE_ATTRIBUTES = re.compile(
    r"_(clock|logger|parameters|context|timers|publishers|subscriptions|clients|services|waitables|guards|descriptors"
    r"|default_callback_group)|executor|get_(logger|clock|name|parameter)"
    r"|create_(timer|publisher|subscription|service|client)"
)
"""Attributes of rclpy's Node that nothing keeps a node class from overwriting."""

_NODE_METHODS = re.compile(
    rf"{_NODE_ATTRIBUTES.pattern}|handle|context|timers|clients|services|publishers|subscriptions|waitables|guards"
    r"|default_callback_group|get_(namespace|parameters)|has_parameter|set_parameters|declare_parameter|add_waitable"
    r"|destroy_node"
)
"""Attributes and methods of rclpy's Node that a method of the same name replaces."""

_REFUSED = re.compile(r"property '(?P<name>\w+)' of '\w+' object has no setter|(?P<handle>handle) cannot be modified")
_USED = re.compile(r"self\.(get_logger|get_clock|get_name|get_parameter|create_\w+)\(|self\.executor\.")
_OF_A_METHOD = re.compile(r"'(method|function)' object|\(\) (takes|missing)")
_OF_A_CALLBACK = re.compile(r"\w\(\) (takes|missing|got)|^$")


def _missing(seen: RaisedException) -> tuple[str, str] | None:
    """The class and the attribute that an AttributeError is about."""
    found = _MISSING.search(seen.traceback.message) if seen.name == "AttributeError" else None
    return (found["owner"], found["name"]) if found is not None else None


def _class(case: Case, name: str) -> tuple[NodeFile, ast.ClassDef] | None:
    for file in case.files:
        for node in file.nodes:
            if isinstance(node, ast.ClassDef) and node.name == name:
                return file, node
    return None


def _set(inside: ast.AST, name: str) -> list[ast.Attribute]:
    """Where self.<name> is set, augmented assignments apart, in source order."""
    augmented = [node.target for node in ast.walk(inside) if isinstance(node, ast.AugAssign)]
    stored = [node for node in ast.walk(inside) if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)]
    found = [node for node in stored if node.attr == name and node not in augmented]
    return sorted(found, key=lambda node: node.lineno)


@mistake(
    "node-used-before-it-is-set-up",
    explains=EXPLAINED,
    evidence=Evidence.PROCESS,
    says="{raised}: {what}",
    do="Call super().__init__ with the node's name as the first thing in __init__.",
    example=from_example(
        Example(
            "AttributeError: 'Bell' object has no attribute '_parameters'",
            "self.declare_parameter('volume', 7)",
            "class Bell(Node):\n    def __init__(self):\n        self.declare_parameter('volume', 7)\n"
            "        super().__init__('bell')\n",
            "__init__",
            "/lib/rclpy/node.py, declare_parameter",
        )
    ),
)
def used_before_set_up(case: Case) -> Iterator[Found]:
    """A node is used before rclpy has set it up.

    Node's own constructor sets up what its methods work with: parameters, timers, publishers. It runs only when your
    __init__ calls it; a class whose __init__ never calls it has none of them.

    Bad:

        class Bell(Node):
            def __init__(self):
                self.declare_parameter('volume', 7)
                super().__init__('bell')

    Good:

        class Bell(Node):
            def __init__(self):
                super().__init__('bell')
                self.declare_parameter('volume', 7)

    See it: the exception names an attribute that begins with an underscore, which is none of yours.
    """
    for seen in raised_in(case):
        missing = _missing(seen)
        if missing is None or not missing[1].startswith("_") or not seen.is_raised_in("rclpy/"):
            continue
        if (owner := _class(case, missing[0])) is None:
            continue
        if calls := calls_in(owner[1], "__init__"):
            what = f"rclpy's Node is set up only in line {calls[0].lineno}"
        else:
            what = "rclpy's Node was never set up, since nothing calls its constructor"
        yield found_in(seen, what=what)


@mistake(
    "name-taken-by-the-node",
    explains=EXPLAINED,
    evidence=Evidence.PROCESS,
    says="{raised}: rclpy's Node uses the name {name} itself{what}",
    do="Give yours a name other than {name}, wherever you use it.",
    example=from_example(
        Example(
            "AttributeError: property 'publishers' of 'Bell' object has no setter",
            "self.publishers = [self.create_publisher(Bool, 'ring', 10)]",
        )
    ),
)
def name_taken(case: Case) -> Iterator[Found]:
    """A node's attribute or method has a name that rclpy's Node uses itself.

    A class that inherits from Node shares its names. A method called `handle`, or an attribute `_timers`, replaces
    Node's own, and rclpy trips over it later; names such as `publishers` cannot be set at all.

    Bad:

        self.publishers = [self.create_publisher(Bool, 'ring', 10)]

    Good:

        self.ring_publishers = [self.create_publisher(Bool, 'ring', 10)]

    See it: `python3 -c "from rclpy.node import Node; print(dir(Node))"`.
    """
    for seen in raised_in(case):
        if seen.name not in ("AttributeError", "TypeError"):
            continue
        message, code = seen.traceback.message, seen.line.code if seen.line is not None else ""
        if (refused := _REFUSED.search(message)) is not None:
            yield found_in(seen, name=refused["name"] or refused["handle"], what=", and it cannot be set")
            continue
        in_rclpy = seen.is_raised_in("rclpy/") and not seen.is_raised_in("rclpy/service.py")
        for file in case.files:
            for name, line in _taken(file, method=_OF_A_METHOD.search(message) is not None):
                is_used = _USED.search(code) is not None and name.strip("_") in code
                of_a_callback = _OF_A_CALLBACK.search(message) is not None and f".{name}()" not in message
                if name == "executor" and seen.name != "AttributeError":
                    continue  # many nodes keep their executor, and do well
                if (in_rclpy or is_used) and not of_a_callback:
                    yield found_in(seen, name=name, what=f", and line {line} replaces it")


def _taken(file: NodeFile, *, method: bool) -> Iterator[tuple[str, int]]:
    """The names of Node's own that a node class sets or, with `method`, defines, each with its line."""
    for owner in (node for node in file.nodes if isinstance(node, ast.ClassDef) and node.name in file.node_classes):
        for node in ast.walk(owner):
            match node:
                case ast.FunctionDef(name=name) if method and _NODE_METHODS.fullmatch(name) and node in owner.body:
                    yield name, node.lineno
                case ast.Attribute(value=ast.Name(id="self"), attr=name, ctx=ast.Store()):
                    if _NODE_ATTRIBUTES.fullmatch(name):
                        yield name, node.lineno
                case ast.Assign(targets=[ast.Name(id=name)]) if node in owner.body:
                    if _NODE_ATTRIBUTES.fullmatch(name):
                        yield name, node.lineno


@mistake(
    "parent-not-set-up",
    explains=EXPLAINED,
    evidence=Evidence.PROCESS,
    says="{raised}: super().__init__ reaches only Node, the first of the parents, so {parent} was never set up",
    do="Call the __init__ of {parent} as well.",
    example=from_example(
        Example(
            "AttributeError: 'Bell' object has no attribute 'rings'",
            "self.rings += 1",
            "class Counter:\n    def __init__(self):\n        self.rings = 0\nclass Bell(Node, Counter):\n"
            "    def __init__(self):\n        super().__init__('bell')\n    def ring(self):\n        self.rings += 1\n",
        )
    ),
)
def parent_not_set_up(case: Case) -> Iterator[Found]:
    """Of two parents, only the first is set up.

    super() stands for the next class in line. rclpy's Node does not pass the call on, so the constructors of the
    parents after it are not called.

    Bad:

        class Bell(Node, Counter):
            def __init__(self):
                super().__init__('bell')

    Good:

        class Bell(Node, Counter):
            def __init__(self):
                Node.__init__(self, 'bell')
                Counter.__init__(self)

    See it: print the attributes of the object at the end of __init__.
    """
    for seen in raised_in(case):
        missing = _missing(seen)
        owner = _class(case, missing[0]) if missing is not None else None
        if missing is None or owner is None:
            continue
        for base in owner[1].bases[1:]:
            parent = _class(case, ast.unparse(base))
            called = {ast.unparse(call.func) for call in calls_in(owner[1], "__init__")}
            if parent is not None and _set(parent[1], missing[1]) and f"{parent[1].name}.__init__" not in called:
                yield found_in(seen, parent=parent[1].name)


@mistake(
    "attribute-used-before-it-is-set",
    explains=EXPLAINED,
    evidence=Evidence.PROCESS,
    says="{raised}: {what}",
    do="{step}",
    example=from_example(
        Example(
            "AttributeError: 'Bell' object has no attribute 'rings'",
            "self.rings += 1",
            "class Bell(Node):\n    def ring(self):\n        self.rings += 1\n",
        )
    ),
)
def used_before_set(case: Case) -> Iterator[Found]:
    """An attribute is used before it has a value.

    An attribute exists once it has been set. The lines of __init__ run from top to bottom, and a callback that adds to
    an attribute, or reads it, needs it to exist.

    Bad:

        class Bell(Node):
            def on_ring(self, message):
                self.rings += 1

    Good:

        class Bell(Node):
            def __init__(self):
                super().__init__('bell')
                self.rings = 0

            def on_ring(self, message):
                self.rings += 1

    See it: the traceback names the line that used it.
    """
    for seen in raised_in(case):
        missing = _missing(seen)
        owner = _class(case, missing[0]) if missing is not None else None
        if missing is None or owner is None or seen.is_raised_in("rclpy/"):
            continue
        name, (file, inside) = missing[1], owner
        where = _set(inside, name)
        if seen.line is not None and any(node.lineno == seen.line.line for node in where):
            continue  # it is being set: the class has slots
        frames = [frame for frame in seen.traceback.frames if frame.name == file.name]
        path = [frame.line for frame in frames if frame.function == "__init__"]
        later = [node for node in where if _is_in_init(file, node) and path and node.lineno > path[-1]]
        if later:
            line = later[0].lineno
            what = f"line {path[-1]} needs self.{name}, which only line {line} sets"
            yield found_in(seen, what=what, step=f"Move line {line} above line {path[-1]}.")
        elif where:
            what = f"only line {where[0].lineno} sets self.{name}, and that has not run yet"
            yield found_in(seen, what=what, step=f"Give self.{name} a first value in __init__.")
        elif f"self.{name}" in (
            ast.unparse(node.target) for node in ast.walk(inside) if isinstance(node, ast.AugAssign)
        ):
            what = f"nothing gives self.{name} a first value"
            yield found_in(seen, what=what, step=f"Give self.{name} a first value in __init__.")


def _is_in_init(file: NodeFile, node: ast.AST) -> bool:
    around = file.function_around(node)
    return around is not None and around.name == "__init__"
