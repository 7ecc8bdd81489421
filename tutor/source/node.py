"""A learner's node, as one file shows it: how the file calls its parts, and which function is which callback."""

from __future__ import annotations

import ast
from collections import Counter
from dataclasses import dataclass
from functools import cached_property, lru_cache

from tutor.source.file import Function, SourceFile
from tutor.source.patterns import argument

SETUP_CALLS = ("create_publisher", "create_timer", "declare_parameter", "declare_parameters")


@dataclass(frozen=True)
class NodeFile(SourceFile):
    """A file that contains one node."""

    @cached_property
    def node(self) -> str:
        """What the node is called where its publisher, timer and parameters are made: usually "self"."""
        owners = [
            ast.unparse(call.func.value) for call in self.calls(*SETUP_CALLS) if isinstance(call.func, ast.Attribute)
        ]
        if owners:
            return Counter(owners).most_common(1)[0][0]
        made = (self.assigned_to(call) for call in self.calls("create_node", "Node"))
        return next((target for target in made if target), "self")

    @cached_property
    def setup(self) -> Function | None:
        """The function that sets the node up: usually `__init__`; None if there is none."""
        creation = next(
            (call for call in self.calls("create_node", "Node") if self.assigned_to(call) == self.node), None
        )
        if creation is not None:
            return self.function_around(creation)
        made = [call for call in self.calls(*SETUP_CALLS) if self.function_around(call) is not None]
        inits = [function for function in self.functions_named("__init__") if self.class_of(function) is not None]
        if inits and (self.node.startswith("self") or not made):
            return next((init for init in inits if any(self.function_around(call) is init for call in made)), inits[0])
        return self.function_around(made[0]) if made else None

    @cached_property
    def timers(self) -> list[ast.Call]:
        """The calls that create timers."""
        return self.calls("create_timer")

    @cached_property
    def first_timer(self) -> ast.Call | None:
        """The call that creates the initial timer: the first one reached from the setup, else the first in the file.

        With several timers, the first one whose callback publishes.
        """
        reached = self.reachable_from(self.setup) if self.setup else []
        found = [call for call in self.timers if self.function_around(call) in reached] or self.timers
        publishing = [call for call in found if self._publishes(argument(call, "callback"))] if found[1:] else []
        return next(iter(publishing or found), None)

    def _publishes(self, callback: ast.expr | None) -> bool:
        function = self.function(callback)
        reached = self.reachable_from(function) if function is not None else []
        return any(self.function_around(call) in reached for call in self.calls("publish"))

    @cached_property
    def timer_callback(self) -> Function | None:
        """The timer's callback; if there is none, the function that publishes."""
        if (callback := self.function(argument(self.first_timer, "callback"))) is not None:
            return callback
        publishing = (self.function_around(call) for call in self.calls("publish"))
        return next((function for function in publishing if function is not None), None)

    @cached_property
    def publisher(self) -> str:
        """The name of the publisher, such as "self.publisher"; empty if there is none."""
        made = (self.assigned_to(call) for call in self.calls("create_publisher", "create_lifecycle_publisher"))
        return next((target for target in made if target), "")

    def callbacks(self, *creators: str) -> list[Function]:
        """The functions given as `callback` to these calls (such as "create_service"), and all that they reach."""
        given = (self.function(argument(call, "callback")) for call in self.calls(*creators))
        reached = (inner for callback in given if callback is not None for inner in self.reachable_from(callback))
        return list(dict.fromkeys(reached))


@lru_cache(maxsize=32)
def node_file(text: str, name: str = "") -> NodeFile:
    """The node of a file, by its text; equal texts share one object."""
    return NodeFile(text, name)
