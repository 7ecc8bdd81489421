"""I2.2: the launch description of a learner's file, rewritten: one node, the list, or the whole function.

Each gives edits in the file's own names, and the imports that they need; none where the file gives no hold for it.
"""

from __future__ import annotations

import ast
import difflib
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from checks.i2_2.reading import Source
from tutor.judge.edits import (
    Edit,
    append_to_function,
    insert_below,
    remove_statement,
    replace_imports,
    replace_lines,
    replace_node,
)
from tutor.judge.rewriting.node import NodeFile, argument, node_file
from tutor.judge.source import Function, called_name, values_of
from tutor.judge.trace import Trace

LAUNCHED = "generate_launch_description"
DEFAULTS = {"topic": "chatter", "namespace": ""}
PACKAGES = ("demo_nodes_py", "demo_nodes_cpp", "my_package")
_SENDING = {"talker": "listener", "minimal_publisher": "minimal_subscriber"}
_TAKING = {taking: sending for sending, taking in _SENDING.items()}
PROGRAMS = (*_SENDING, *_TAKING)
_MODULES = {
    "LaunchDescription": "launch",
    "DeclareLaunchArgument": "launch.actions",
    "LaunchConfiguration": "launch.substitutions",
    "Node": "launch_ros.actions",
}
_PLACES = {
    "launch.actions": (
        *("DeclareLaunchArgument", "ExecuteProcess", "GroupAction", "IncludeLaunchDescription", "LogInfo"),
        *("OpaqueFunction", "RegisterEventHandler", "SetEnvironmentVariable", "TimerAction"),
    ),
    "launch.conditions": ("IfCondition", "UnlessCondition"),
    "launch.event_handlers": ("OnProcessExit", "OnProcessStart"),
    "launch.launch_description_sources": ("PythonLaunchDescriptionSource",),
    "launch.substitutions": ("LaunchConfiguration", "PathJoinSubstitution", "PythonExpression", "TextSubstitution"),
    "launch_ros.actions": ("LifecycleNode", "Node", "PushRosNamespace", "SetParameter", "SetRemap"),
    "launch_ros.substitutions": ("FindPackageShare",),
    "launch": ("LaunchDescription",),
}
"""Where the classes are that a launch file imports."""
_OWN_TOPIC = re.compile(r"create_(?:publisher|subscription)\([^'\"]*['\"]([\w/]+)['\"]")


@dataclass(frozen=True)
class Program:
    """What a node runs, and what its own code calls the topic."""

    package: str
    executable: str
    topic: str = DEFAULTS["topic"]


@dataclass(frozen=True)
class Launch:
    """A launch file, the learner's other files beside it, and what it calls the classes of launch."""

    file: NodeFile
    others: Mapping[str, str]
    path: str = "my_launch.py"

    def name(self, of: str) -> str:
        """What the file calls a class."""
        return self.file.own(of, _MODULES[of])[0]

    def imports(self, *names: str) -> list[Edit]:
        """The imports that these classes need, as far as they are missing."""
        if any(alias.name == "*" for _, alias in self.file.imports):
            names = tuple(each for each in names if not self.calls(each))
        return [edit for each in names for edit in self.file.own(each, _MODULES[each])[1]]

    def calls(self, of: str) -> list[ast.Call]:
        """Where something of this class is made."""
        return self.file.calls(self.name(of).rpartition(".")[2])

    @property
    def source(self) -> Source:
        """The file as it is read for the texts of a diagnosis."""
        return Source(self.file.text)

    @property
    def demo(self) -> list[Program]:
        """What is known to be there, and to work."""
        return [Program(PACKAGES[0], "talker"), Program(PACKAGES[0], "listener")]

    def step(self, *choices: Sequence[Edit] | None) -> str | None:
        """The first of these edits that leaves a file which Python can run, in words; None where there is none."""
        found = self.file.step(*choices)
        return f"in {self.path}, {found}" if found and self.others else found

    @property
    def function(self) -> Function | None:
        """The function that launch calls, or the one that is meant for it."""
        named = [each for each in self.file.functions if each.name == LAUNCHED]
        made = [
            found for each in self.calls("LaunchDescription") if (found := self.file.function_around(each)) is not None
        ]
        return next(iter([*named[-1:], *made]), None)

    def value(self, of: str) -> str:
        """How the file gives the value of an argument."""
        return f"{self.name('LaunchConfiguration')}('{of}')"

    def declaration(self, of: str) -> str:
        """The declaration of an argument, with the default that it has."""
        return f"{self.name('DeclareLaunchArgument')}('{of}', default_value={self._default(of)!r})"

    def _default(self, of: str) -> str:
        for call in self.declared(of):
            given = argument(call, 1, "default_value")
            if isinstance(given, ast.Constant) and isinstance(given.value, str) and not given.value.startswith("/"):
                return given.value or DEFAULTS[of] if of in DEFAULTS else given.value
        return DEFAULTS.get(of, "")

    def declared(self, of: str) -> list[ast.Call]:
        """Where an argument is declared."""
        return [each for each in self.calls("DeclareLaunchArgument") if _text(argument(each, 0, "name")) == of]

    def programs(self) -> list[Program]:
        """What the file starts, as far as it is known to be there, and what is missing for a pair."""
        found = [each for call in self.calls("Node") if (each := self._program(call)) is not None]
        found = list(dict.fromkeys(found))
        kinds = {each.executable for each in found}
        if len(found) == 1 or (kinds <= set(_SENDING) or kinds <= set(_TAKING)):
            one = found[0] if found else Program(PACKAGES[0], "talker")
            other = (_SENDING | _TAKING).get(one.executable, "")
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
        return _text(given)


def launch(trace: Trace) -> Launch:
    """The learner's launch file that was started."""
    others = {name: text for name, text in trace.sources.items() if name != trace.file}
    return Launch(node_file(trace.sources.get(trace.file, "")), others, trace.file)


def rewrite_description(there: Launch, programs: Sequence[Program] = ()) -> list[Edit]:
    """The function as a whole: both arguments declared first, then each node in the namespace and on the topic."""
    function = there.function
    names = ("Node", "LaunchConfiguration", "DeclareLaunchArgument", "LaunchDescription")
    imports = there.imports(*names)
    nodes = [line for each in programs or there.programs() for line in _node(there, each)]
    code = "\n".join(
        [
            f"return {there.name('LaunchDescription')}([",
            *(f"    {there.declaration(each)}," for each in DEFAULTS),
            *(f"    {line}" for line in nodes),
            "])",
        ]
    )
    if not there.file.tree.body:
        lines = len(there.file.text.splitlines())
        froms = "\n".join(sorted(f"from {_MODULES[each]} import {each}" for each in names))
        body = "".join(f"\n    {line}" for line in code.splitlines())
        return [Edit(1, lines, f"{froms}\n\n\ndef {LAUNCHED}():{body}")] if lines else []
    if function is None or function.name != LAUNCHED or function.lineno == function.body[0].lineno:
        last = there.file.tree.body[-1]
        body = "".join(f"\n    {line}" for line in code.splitlines())
        like = next((each.lineno for each in there.file.tree.body), 1)
        return [*imports, insert_below(last.end_lineno or last.lineno, f"\n\ndef {LAUNCHED}():{body}", like=like)]
    first, last_ = function.body[0], function.body[-1]
    if ast.get_docstring(function) is not None and len(function.body) > 1:
        first = function.body[1]
    return [*imports, Edit(first.lineno, last_.end_lineno or last_.lineno, code, like=first.lineno)]


def _node(there: Launch, program: Program) -> Iterator[str]:
    yield f"{there.name('Node')}("
    yield f"    package='{program.package}',"
    yield f"    executable='{program.executable}',"
    yield f"    namespace={there.value('namespace')},"
    yield f"    remappings=[('{program.topic}', {there.value('topic')})],"
    yield "    output='screen',"
    yield "),"


def fix_imports(there: Launch) -> list[Edit]:
    """The imports of classes from where they are not, with the module that has them."""
    edits = []
    for each in there.file.tree.body:
        if isinstance(each, ast.ImportFrom) and not each.level:
            found = [(alias, _place(alias.name)) for alias in each.names]
            moved = [(alias, f"from {at} import {alias.name}") for alias, at in found if at not in ("", each.module)]
            edits += [replace_imports(each, moved)] if moved else []
    return edits


def _place(name: str) -> str:
    return next((module for module, names in _PLACES.items() if name in names), "")


def add_node_argument(there: Launch, keyword: str, value: str, *without: str) -> list[Edit]:
    """Every node with this argument, and without others; none where a node has arguments in a dict, `**common`."""
    edits = []
    if any(each.arg is None for call in there.calls("Node") for each in call.keywords):
        return []
    for call in there.calls("Node"):
        kept = [each for each in call.keywords if each.arg not in without]
        had = next((each.value for each in kept if each.arg == keyword), None)
        if had is not None and len(kept) == len(call.keywords):
            edits.append(replace_node(there.file.text, had, value))
            continue
        words = [f"{each.arg}={value if each.arg == keyword else ast.unparse(each.value)}" for each in kept if each.arg]
        added = [] if had is not None else [f"{keyword}={value}"]
        parts = [*map(ast.unparse, call.args), *words, *added]
        edits.append(replace_node(there.file.text, call, f"{ast.unparse(call.func)}({', '.join(parts)})"))
    return [*there.imports("LaunchConfiguration"), *edits]


def prepend_to_list(there: Launch, *wanted: str) -> list[Edit]:
    """What the list of the launch description begins with."""
    made = next(iter(there.calls("LaunchDescription")), None)
    given_ = argument(made, 0, "initial_entities") if made is not None else None
    if isinstance(given_, ast.Name) and there.function is not None:
        given_ = next(iter(values_of(given_.id, there.function)), None)
    if not isinstance(given_, ast.List) or not given_.elts:
        return []
    first = given_.elts[0]
    code = ast.get_source_segment(there.file.text, first) or ""
    if "\n" in code:
        alone = there.file.text.splitlines()[first.lineno - 1][: first.col_offset].strip() == ""
        return [Edit(first.lineno, first.lineno - 1, ",\n".join(wanted) + ",", like=first.lineno)] if alone else []
    return [replace_node(there.file.text, first, f"{', '.join(wanted)}, {code}")]


def rename_argument(there: Launch, other: str, right: str) -> list[Edit]:
    """An argument of another name, wherever it is named."""
    found = [
        name
        for each in (*there.calls("DeclareLaunchArgument"), *there.calls("LaunchConfiguration"))
        if (name := each.args[0] if each.args else None) is not None and _text(name) == other
    ]
    lines = [each.lineno for each in found]
    if len(lines) != len(set(lines)):
        return []
    return [replace_node(there.file.text, each, repr(right)) for each in found]


def replace_keyword(there: Launch, keyword: str, wrong: str, right: str) -> list[Edit]:
    """A package or an executable of another name."""
    found = [each.value for call in there.calls("Node") for each in call.keywords if each.arg == keyword]
    return [replace_node(there.file.text, each, repr(right)) for each in found if _text(each) == wrong] if right else []


def return_description(there: Launch) -> list[Edit]:
    """The launch description, returned."""
    made, function = next(iter(there.calls("LaunchDescription")), None), there.function
    if made is None or function is None or there.file.function_around(made) is not function:
        return []
    if kept := there.file.assigned_to(made):
        return [append_to_function(function, f"return {kept}")]
    line = there.file.text.splitlines()[made.lineno - 1].strip()
    return [replace_lines(made.lineno, f"return {line}")]


def return_opaque_actions(there: Launch) -> list[Edit]:
    """What the function of an OpaqueFunction makes, returned where it ends."""
    for call in there.file.calls("OpaqueFunction"):
        function = there.file.function(argument(call, 0, "function"))
        if function is None or any(isinstance(each, ast.Return) and each.value for each in ast.walk(function)):
            continue
        made = [each for each in ast.walk(function) if isinstance(each, ast.Assign)]
        lists = [each for each in made if isinstance(each.value, ast.List)]
        nodes = [each for each in made if isinstance(each.value, ast.Call) and each.value in there.calls("Node")]
        if lists and not nodes:
            return [append_to_function(function, f"return {ast.unparse(lists[-1].targets[0])}")]
        last = function.body[-1]
        if isinstance(last, ast.Expr) and isinstance(last.value, ast.List):
            return [replace_lines(last.lineno, f"return {there.file.text.splitlines()[last.lineno - 1].strip()}")]
        if nodes:
            return [
                append_to_function(function, f"return [{', '.join(ast.unparse(each.targets[0]) for each in nodes)}]")
            ]
    return []


def remove_exits(there: Launch) -> list[Edit]:
    """The file without what ends Python while it is loaded."""
    ends = ("exit", "_exit", "quit", "abort", "kill")
    return [
        remove_statement(there.file.text, each)
        for each in there.file.tree.body
        if isinstance(each, ast.Expr) and isinstance(each.value, ast.Call) and called_name(each.value) in ends
    ]


def rename_function(there: Launch) -> list[Edit]:
    """The function that describes the launch, with the name that launch calls."""
    function = there.function
    if function is None or function.args.args or function.name == LAUNCHED:
        return []
    line = there.file.text.splitlines()[function.lineno - 1].strip()
    return [replace_lines(function.lineno, line.replace(f"def {function.name}(", f"def {LAUNCHED}(", 1))]


def nearest(wrong: str, known: Sequence[str]) -> str:
    """What was probably meant, or nothing."""
    return next(iter(difflib.get_close_matches(wrong, known, n=1, cutoff=0.5)), "")


def _text(given_: ast.expr | None) -> str:
    return given_.value if isinstance(given_, ast.Constant) and isinstance(given_.value, str) else ""
