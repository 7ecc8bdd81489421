"""Known exceptions, as data: what they mean in a node, and the step that fixes them. See CONTRIBUTING.md."""

from tutor.judge.exceptions.matching import Seen, find
from tutor.judge.exceptions.table import Example, Known, Replace, TableError, load, parse, shipped

__all__ = ["Example", "Known", "Replace", "Seen", "TableError", "find", "load", "parse", "shipped"]
