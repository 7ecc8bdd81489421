"""All files of a learner's program: the file that was run first, then the modules beside it that it imports."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from tutor.source.file import Function, called_name, calls_in, last_name
from tutor.source.node import NodeFile, node_file


@dataclass(frozen=True)
class Program:
    """The program's files by name, as a trace holds them, and the name of the file that was run."""

    sources: Mapping[str, str]
    started: str

    @cached_property
    def file(self) -> NodeFile:
        """The file that was run; an empty one if it could not be read."""
        return node_file(self.sources.get(self.started, ""), self.started)

    @cached_property
    def files(self) -> tuple[NodeFile, ...]:
        """The file that was run, then the others."""
        others = (node_file(text, name) for name, text in self.sources.items() if name != self.started)
        return (self.file, *others)

    def named(self, name: str) -> NodeFile:
        """The file with this name; an empty one if there is none."""
        return node_file(self.sources.get(name, ""), name)

    def holding(self, node: ast.AST) -> NodeFile:
        """The file whose syntax tree contains a node."""
        return next(file for file in self.files if node in file.nodes)

    def calling(self, *names: str) -> NodeFile:
        """The first file that calls one of these functions; else the file that was run."""
        return next((file for file in self.files if file.calls(*names)), self.file)

    def nodes(self) -> Iterator[ast.AST]:
        """All nodes of the syntax trees."""
        for file in self.files:
            yield from file.nodes

    def calls(self, *names: str) -> list[ast.Call]:
        """The calls of functions and methods with these names, file by file, in source order."""
        return [call for file in self.files for call in file.calls(*names)]

    def mentions(self, *names: str) -> bool:
        """Whether any of these names is used anywhere, as a variable, a function or an attribute."""
        return any(isinstance(node, ast.Name | ast.Attribute) and last_name(node) in names for node in self.nodes())

    def callbacks(self, creator: str) -> list[Function]:
        """The functions passed to `creator`, such as "create_subscription", and all functions they reach, by name."""
        arguments = [
            given
            for call in self.calls(creator)
            for given in (*call.args, *(keyword.value for keyword in call.keywords))
        ]
        inside = [call for given in arguments if isinstance(given, ast.Lambda) for call in calls_in(given)]
        todo = [last_name(given) for given in arguments] + [called_name(call) for call in inside]
        found: dict[str, list[Function]] = {}
        while todo:
            name = todo.pop(0)
            named = [function for file in self.files for function in file.functions_named(name)]
            if named and name not in found:
                found[name] = named
                todo += [called_name(call) for function in named for call in calls_in(function)]
        return [function for named in found.values() for function in named]
