"""Known exceptions, as data: what they mean in a node, and the step that fixes them. See CONTRIBUTING.md."""

from tutor.judge.exceptions.matching import RaisedException, explain
from tutor.judge.exceptions.table import load, load_shipped, parse
from tutor.judge.known_exception import Example, KnownException, Replace

__all__ = ["Example", "KnownException", "RaisedException", "Replace", "explain", "load", "load_shipped", "parse"]
