"""I2.2: a learner's launch file: its own names, arguments and programs."""

from __future__ import annotations

import ast
import difflib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from checks.i2_2.reading import Source
from tutor.judge.edits import (
    Edit,
)
from tutor.judge.rewriting.node import NodeFile, argument, node_file
from tutor.judge.source import Function, values_of
from tutor.judge.trace import Trace

LAUNCHED = "generate_launch_description"
DEFAULTS = {"topic": "chatter", "namespace": ""}
PACKAGES = ("demo_nodes_py", "demo_nodes_cpp", "my_package")
_SUBSCRIBER_OF = {"talker": "listener", "minimal_publisher": "minimal_subscriber"}
_PUBLISHER_OF = {subscriber: publisher for publisher, subscriber in _SUBSCRIBER_OF.items()}
PROGRAMS = (*_SUBSCRIBER_OF, *_PUBLISHER_OF)
MODULES = {
    "LaunchDescription": "launch",
    "DeclareLaunchArgument": "launch.actions",
    "LaunchConfiguration": "launch.substitutions",
    "Node": "launch_ros.actions",
}
_VALID_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")
"""A relative name that ROS accepts for a topic or namespace."""
_OWN_TOPIC = re.compile(r"create_(?:publisher|subscription)\([^'\"]*['\"]([\w/]+)['\"]")


@dataclass(frozen=True)
class Program:
    """The program that a node runs, and the topic name in its code."""

    package: str
    executable: str
    topic: str = DEFAULTS["topic"]


@dataclass(frozen=True)
class Launch:
    """A launch file. `others`: the learner's other files, by name."""

    file: NodeFile
    others: Mapping[str, str]
    path: str = "my_launch.py"

    def name(self, of: str) -> str:
        """The file's own expression for a class."""
        return self.file.import_name(of, MODULES[of])[0]

    def imports(self, *names: str) -> list[Edit]:
        """The missing imports of these classes, as edits."""
        if any(alias.name == "*" for _, alias in self.file.imports):
            names = tuple(each for each in names if not self.calls(each))
        return [edit for each in names for edit in self.file.import_name(each, MODULES[each])[1]]

    def calls(self, of: str) -> list[ast.Call]:
        """The calls that create an instance of this class."""
        return self.file.calls(self.name(of).rpartition(".")[2])

    @property
    def source(self) -> Source:
        """The file, parsed for the texts of a diagnosis."""
        return Source(self.file.text)

    @property
    def demo(self) -> list[Program]:
        """The demo nodes, which are known to exist and to work."""
        return [Program(PACKAGES[0], "talker"), Program(PACKAGES[0], "listener")]

    def step(self, *choices: Sequence[Edit] | None) -> str | None:
        """Describe the first choice of edits that leaves a valid Python file; None if none does."""
        found = self.file.step(*choices)
        return f"in {self.path}, {found}" if found and self.others else found

    @property
    def function(self) -> Function | None:
        """The function `generate_launch_description`, or else one that creates a LaunchDescription."""
        named = [each for each in self.file.functions if each.name == LAUNCHED]
        made = [
            found for each in self.calls("LaunchDescription") if (found := self.file.function_around(each)) is not None
        ]
        return next(iter([*named[-1:], *made]), None)

    def value(self, of: str) -> str:
        """The expression for the value of a launch argument."""
        return f"{self.name('LaunchConfiguration')}('{of}')"

    def declaration(self, of: str) -> str:
        """The declaration of a launch argument, with its current default if it has one."""
        return f"{self.name('DeclareLaunchArgument')}('{of}', default_value={self._default(of)!r})"

    def _default(self, of: str) -> str:
        for call in self.declared(of):
            given = argument(call, 1, "default_value")
            if isinstance(given, ast.Constant) and _VALID_NAME.fullmatch(str(given.value)):
                return str(given.value)
        return DEFAULTS.get(of, "")

    def declared(self, of: str) -> list[ast.Call]:
        """The declarations of a launch argument."""
        return [each for each in self.calls("DeclareLaunchArgument") if constant_text(argument(each, 0, "name")) == of]

    def programs(self) -> list[Program]:
        """The programs that the file starts, as far as they are known to exist; a single one is completed to a pair."""
        found = [each for call in self.calls("Node") if (each := self._program(call)) is not None]
        found = list(dict.fromkeys(found))
        executables = {each.executable for each in found}
        if len(found) == 1 or (executables <= set(_SUBSCRIBER_OF) or executables <= set(_PUBLISHER_OF)):
            one = found[0] if found else Program(PACKAGES[0], "talker")
            other = (_SUBSCRIBER_OF | _PUBLISHER_OF).get(one.executable, "")
            partner = Program(one.package, other) if other else self._partner(one)
            return [one, partner]
        return found

    def _partner(self, one: Program) -> Program:
        text = self.others.get(f"{one.executable}.py", "")
        return Program(PACKAGES[0], "listener" if "create_publisher" in text else "talker")

    def _program(self, call: ast.Call) -> Program | None:
        package = self._constant(argument(call, 0, "package"))
        executable = self._constant(argument(call, 1, "executable"))
        if f"{executable}.py" in self.others:
            found = _OWN_TOPIC.search(self.others[f"{executable}.py"])
            return Program("my_package", executable, found[1] if found else DEFAULTS["topic"])
        executable = nearest(executable, PROGRAMS)
        if not executable:
            return None
        package = nearest(package, PACKAGES)
        right = package == "my_package" if executable.startswith("minimal") else package.startswith("demo")
        return Program(
            package if right else "my_package" if executable.startswith("minimal") else PACKAGES[0], executable
        )

    def _constant(self, given: ast.expr | None) -> str:
        if isinstance(given, ast.Name):
            given = next(iter(values_of(given.id, self.file.tree)), None)
        return constant_text(given)


def launch(trace: Trace) -> Launch:
    """Return the learner's launch file that was started."""
    others = {name: text for name, text in trace.sources.items() if name != trace.file}
    return Launch(node_file(trace.sources.get(trace.file, "")), others, trace.file)


def nearest(wrong: str, known: Sequence[str]) -> str:
    """The known name that was probably meant, or ""."""
    return next(iter(difflib.get_close_matches(wrong, known, n=1, cutoff=0.5)), "")


def constant_text(given: ast.expr | None) -> str:
    """The value of a string literal; "" for anything else."""
    return given.value if isinstance(given, ast.Constant) and isinstance(given.value, str) else ""
