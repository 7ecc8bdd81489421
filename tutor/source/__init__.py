"""A learner's source, read for the wording of a diagnosis, never for a verdict."""

from tutor.source.file import (
    Function,
    SourceFile,
    called_name,
    calls_in,
    is_abstract,
    is_endless,
    last_name,
    values_of,
)
from tutor.source.loops import Loop, only_waits, outermost_loop
from tutor.source.node import NodeFile, node_file
from tutor.source.patterns import Holes, argument, fill, find, match
from tutor.source.program import Program

__all__ = [
    "Function",
    "Holes",
    "Loop",
    "NodeFile",
    "Program",
    "SourceFile",
    "argument",
    "called_name",
    "calls_in",
    "fill",
    "find",
    "is_abstract",
    "is_endless",
    "last_name",
    "match",
    "node_file",
    "only_waits",
    "outermost_loop",
    "values_of",
]
