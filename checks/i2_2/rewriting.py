"""I2.2: edits of a learner's launch file: one node, the list of actions, or the whole function.

The edits use the file's own names, and add the imports that they need; there are none where the file has no place for
them.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from checks.i2_2.launch_file import DEFAULTS, LAUNCHED, MODULES, Launch, Program, constant_text
from tutor.judge.edits import (
    Edit,
    append_to_function,
    insert_below,
    remove_statement,
    replace_imports,
    replace_lines,
    replace_node,
)
from tutor.judge.rewriting.node import argument
from tutor.judge.source import called_name, values_of

_CLASSES_OF_MODULE = {
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
"""The modules of the classes that a launch file may import."""


def rewrite_description(launch_file: Launch, programs: Sequence[Program] = ()) -> list[Edit]:
    """Rewrite the whole function: declare both arguments first, then each node with namespace and remapping."""
    function = launch_file.function
    names = ("Node", "LaunchConfiguration", "DeclareLaunchArgument", "LaunchDescription")
    imports = launch_file.imports(*names)
    nodes = [line for each in programs or launch_file.programs() for line in _node_lines(launch_file, each)]
    code = "\n".join(
        [
            f"return {launch_file.name('LaunchDescription')}([",
            *(f"    {launch_file.declaration(each)}," for each in DEFAULTS),
            *(f"    {line}" for line in nodes),
            "])",
        ]
    )
    body = "".join(f"\n    {line}" for line in code.splitlines())
    if not launch_file.file.tree.body:
        lines = len(launch_file.file.text.splitlines())
        import_lines = "\n".join(sorted(f"from {MODULES[each]} import {each}" for each in names))
        return [Edit(1, lines, f"{import_lines}\n\n\ndef {LAUNCHED}():{body}")] if lines else []
    if function is None or function.name != LAUNCHED or function.lineno == function.body[0].lineno:
        last = launch_file.file.tree.body[-1]
        like = next((each.lineno for each in launch_file.file.tree.body), 1)
        return [*imports, insert_below(last.end_lineno or last.lineno, f"\n\ndef {LAUNCHED}():{body}", like=like)]
    first, end = function.body[0], function.body[-1]
    if ast.get_docstring(function) is not None and len(function.body) > 1:
        first = function.body[1]
    return [*imports, Edit(first.lineno, end.end_lineno or end.lineno, code, like=first.lineno)]


def _node_lines(launch_file: Launch, program: Program) -> Iterator[str]:
    yield f"{launch_file.name('Node')}("
    yield f"    package='{program.package}',"
    yield f"    executable='{program.executable}',"
    yield f"    namespace={launch_file.value('namespace')},"
    yield f"    remappings=[('{program.topic}', {launch_file.value('topic')})],"
    yield "    output='screen',"
    yield "),"


def fix_imports(launch_file: Launch) -> list[Edit]:
    """Correct the imports of classes from the wrong module."""
    edits = []
    for each in launch_file.file.tree.body:
        if isinstance(each, ast.ImportFrom) and not each.level:
            found = [(alias, _module_of(alias.name)) for alias in each.names]
            moved = [(alias, f"from {at} import {alias.name}") for alias, at in found if at not in ("", each.module)]
            edits += [replace_imports(each, moved)] if moved else []
    return edits


def _module_of(name: str) -> str:
    return next((module for module, names in _CLASSES_OF_MODULE.items() if name in names), "")


def add_node_argument(launch_file: Launch, keyword: str, value: str, *without: str) -> list[Edit]:
    """Give every node this argument, and drop those in `without`; no edits if a node takes a dict, `**common`."""
    edits = []
    if any(each.arg is None for call in launch_file.calls("Node") for each in call.keywords):
        return []
    for call in launch_file.calls("Node"):
        kept = [each for each in call.keywords if each.arg not in without]
        present = next((each.value for each in kept if each.arg == keyword), None)
        if present is not None and len(kept) == len(call.keywords):
            edits.append(replace_node(launch_file.file.text, present, value))
            continue
        words = [f"{each.arg}={value if each.arg == keyword else ast.unparse(each.value)}" for each in kept if each.arg]
        added = [] if present is not None else [f"{keyword}={value}"]
        parts = [*map(ast.unparse, call.args), *words, *added]
        edits.append(replace_node(launch_file.file.text, call, f"{ast.unparse(call.func)}({', '.join(parts)})"))
    return [*launch_file.imports("LaunchConfiguration"), *edits]


def prepend_to_list(launch_file: Launch, *wanted: str) -> list[Edit]:
    """Insert entries at the beginning of the launch description's list."""
    made = next(iter(launch_file.calls("LaunchDescription")), None)
    entries = argument(made, 0, "initial_entities") if made is not None else None
    if isinstance(entries, ast.Name) and launch_file.function is not None:
        entries = next(iter(values_of(entries.id, launch_file.function)), None)
    if not isinstance(entries, ast.List) or not entries.elts:
        return []
    first = entries.elts[0]
    code = ast.get_source_segment(launch_file.file.text, first) or ""
    if "\n" in code:
        alone = launch_file.file.text.splitlines()[first.lineno - 1][: first.col_offset].strip() == ""
        return [Edit(first.lineno, first.lineno - 1, ",\n".join(wanted) + ",", like=first.lineno)] if alone else []
    return [replace_node(launch_file.file.text, first, f"{', '.join(wanted)}, {code}")]


def rename_argument(launch_file: Launch, other: str, right: str) -> list[Edit]:
    """Rename a launch argument wherever it is declared or read."""
    found = [
        name
        for each in (*launch_file.calls("DeclareLaunchArgument"), *launch_file.calls("LaunchConfiguration"))
        if (name := each.args[0] if each.args else None) is not None and constant_text(name) == other
    ]
    lines = [each.lineno for each in found]
    if len(lines) != len(set(lines)):
        return []
    return [replace_node(launch_file.file.text, each, repr(right)) for each in found]


def replace_keyword(launch_file: Launch, keyword: str, wrong: str, right: str) -> list[Edit]:
    """Correct the name of a package or an executable."""
    found = [each.value for call in launch_file.calls("Node") for each in call.keywords if each.arg == keyword]
    return (
        [replace_node(launch_file.file.text, each, repr(right)) for each in found if constant_text(each) == wrong]
        if right
        else []
    )


def return_description(launch_file: Launch) -> list[Edit]:
    """Return the launch description that the function creates."""
    made, function = next(iter(launch_file.calls("LaunchDescription")), None), launch_file.function
    if made is None or function is None or launch_file.file.function_around(made) is not function:
        return []
    if kept := launch_file.file.assigned_to(made):
        return [append_to_function(function, f"return {kept}")]
    line = launch_file.file.text.splitlines()[made.lineno - 1].strip()
    return [replace_lines(made.lineno, f"return {line}")]


def return_opaque_actions(launch_file: Launch) -> list[Edit]:
    """Let the function of an OpaqueFunction return the actions that it creates."""
    for call in launch_file.file.calls("OpaqueFunction"):
        function = launch_file.file.function(argument(call, 0, "function"))
        if function is None or any(isinstance(each, ast.Return) and each.value for each in ast.walk(function)):
            continue
        made = [each for each in ast.walk(function) if isinstance(each, ast.Assign)]
        lists = [each for each in made if isinstance(each.value, ast.List)]
        nodes = [each for each in made if isinstance(each.value, ast.Call) and each.value in launch_file.calls("Node")]
        if lists and not nodes:
            return [append_to_function(function, f"return {ast.unparse(lists[-1].targets[0])}")]
        last = function.body[-1]
        if isinstance(last, ast.Expr) and isinstance(last.value, ast.List):
            return [replace_lines(last.lineno, f"return {launch_file.file.text.splitlines()[last.lineno - 1].strip()}")]
        if nodes:
            return [
                append_to_function(function, f"return [{', '.join(ast.unparse(each.targets[0]) for each in nodes)}]")
            ]
    return []


def remove_exits(launch_file: Launch) -> list[Edit]:
    """Remove module-level calls that end Python while the file is being loaded."""
    ends = ("exit", "_exit", "quit", "abort", "kill")
    return [
        remove_statement(launch_file.file.text, each)
        for each in launch_file.file.tree.body
        if isinstance(each, ast.Expr) and isinstance(each.value, ast.Call) and called_name(each.value) in ends
    ]


def rename_function(launch_file: Launch) -> list[Edit]:
    """Rename the function that creates the launch description to the name that launch calls."""
    function = launch_file.function
    if function is None or function.args.args or function.name == LAUNCHED:
        return []
    line = launch_file.file.text.splitlines()[function.lineno - 1].strip()
    return [replace_lines(function.lineno, line.replace(f"def {function.name}(", f"def {LAUNCHED}(", 1))]
