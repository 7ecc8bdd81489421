"""Known exceptions as data: what each one means in a node, and the step that fixes it. See CONTRIBUTING.md."""

from tutor.judge.exceptions.matching import RaisedException, explain
from tutor.judge.exceptions.table import load, load_shipped, parse
from tutor.judge.known_exception import Example, KnownException, Replace

__all__ = ["Example", "KnownException", "RaisedException", "Replace", "explain", "load", "load_shipped", "parse"]
