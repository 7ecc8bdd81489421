"""I2.2: next steps that refer to lines and names of the learner's own file.

The source only determines the wording; the fault itself was observed in the launch.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Sequence
from dataclasses import replace

from checks.i2_2.launch_file import DEFAULTS, PACKAGES, PROGRAMS, Launch, Program, constant_text, nearest
from checks.i2_2.reading import Call, Source, summands
from checks.i2_2.rewriting import (
    add_node_argument,
    fix_imports,
    prepend_to_list,
    remove_exits,
    rename_argument,
    rename_function,
    replace_keyword,
    return_description,
    return_opaque_actions,
    rewrite_description,
)
from tutor.judge.edits import Edit, replace_node, replace_nodes
from tutor.judge.rewriting.node import argument
from tutor.judge.step_parsing import NotAnEdit, apply_step
from tutor.judge.verdict import Cause

_NO_IMPORT = re.compile(r"\b(?:ImportError|ModuleNotFoundError)\b")

_MODULES = {"LaunchConfiguration": "launch.substitutions", "DeclareLaunchArgument": "launch.actions"}
_CLASS_NAME = re.compile(
    r"(?<![\w.'])(?:LaunchConfiguration|DeclareLaunchArgument|LaunchDescription|Node|SetRemap)(?=\()"
)


def nodes(source: Source) -> list[Call]:
    """The calls that describe a node."""
    return source.calls("Node", "LifecycleNode")


def rewrite_launch_file(launch_file: Launch) -> str | None:
    """The step that rewrites the launch description, with the file's own programs or else with the demo nodes."""
    return launch_file.step(rewrite_description(launch_file), rewrite_description(launch_file, launch_file.demo))


def with_applicable_step(launch_file: Launch, cause: Cause, programs: Sequence[Program] = ()) -> Cause:
    """The cause with a hint that is an edit: a hint in prose is replaced by a rewritten launch description."""
    try:
        apply_step(cause.hint, {launch_file.path: launch_file.file.text, **launch_file.others})
    except NotAnEdit:
        step = launch_file.step(fix_imports(launch_file)) if _NO_IMPORT.search(cause.text) else None
        step = step or (
            launch_file.step(rewrite_description(launch_file, programs))
            if programs
            else rewrite_launch_file(launch_file)
        )
        return replace(cause, hint=step or cause.hint)
    return cause


def value(source: Source, argument: str) -> str:
    """The file's expression for the argument's value: a variable, or the substitution itself."""
    written = f"LaunchConfiguration('{argument}'"
    for target, set_to in source.assignments():
        if set_to.startswith(written) and set_to.endswith(")") and target.isidentifier():
            return target
    return f"{written})"


def declaration(argument: str) -> str:
    """The code that declares the argument."""
    return f"DeclareLaunchArgument('{argument}', default_value='{DEFAULTS.get(argument, '')}')"


def rename_package(launch_file: Launch, wrong: str) -> str | None:
    """The step that replaces the name of a package by the nearest one that exists."""
    return launch_file.step(replace_keyword(launch_file, "package", wrong, nearest(wrong, PACKAGES)))


def rename_programs(launch_file: Launch, wrong: str) -> str | None:
    """The step that replaces the name of an executable, and all others that do not exist, by the nearest one."""
    given = {constant_text(argument(call, 1, "executable")) for call in launch_file.calls("Node")}
    unknown = {each for each in given if each and each not in PROGRAMS and f"{each}.py" not in launch_file.others}
    return launch_file.step(
        [
            edit
            for each in sorted({wrong, *unknown})
            for edit in replace_keyword(launch_file, "executable", each, nearest(each, PROGRAMS))
        ]
    )


def step_for_empty_description(launch_file: Launch) -> str | None:
    """The step where the launch description is empty."""
    made = [node.kept for node in nodes(launch_file.source) if node.kept and not launch_file.source.uses(node.kept)]
    return launch_file.step(
        remove_exits(launch_file),
        return_opaque_actions(launch_file),
        prepend_to_list(launch_file, *made) if made else None,
    )


def replace_default(launch_file: Launch, wrong: str) -> str | None:
    """The step that replaces a default that is not a valid name with one that is: `robot-news` with `robot_news`."""
    right = re.sub(r"\W", "_", wrong, flags=re.ASCII).strip("_")
    right = f"topic_{right}" if not right or right[0].isdigit() else right
    defaults = [argument(call, 1, "default_value") for call in launch_file.calls("DeclareLaunchArgument")]
    found = [each for each in defaults if isinstance(each, ast.Constant) and each.value == wrong]
    return launch_file.step([replace_node(launch_file.file.text, each, repr(right)) for each in found])


def add_return(launch_file: Launch) -> str | None:
    """The step that makes generate_launch_description() return the description."""
    return launch_file.step(return_description(launch_file))


def rename_launch_function(launch_file: Launch) -> str | None:
    """The step that names the function generate_launch_description, if none is called that."""
    return launch_file.step(rename_function(launch_file))


def rename_similar_argument(launch_file: Launch, argument: str, others: Sequence[str]) -> str | None:
    """The step that renames a similar argument among `others` to `argument`."""
    near = [other for other in others if len(others) == 1 or argument[:2] in other]
    if len(near) > 1:  # one for each node
        return launch_file.step(
            [*rename_argument(launch_file, near[0], argument), *_read(launch_file, near[1:], argument)]
        )
    return next((step for each in near if (step := rename_argument_step(launch_file, each, argument))), None)


def _read(launch_file: Launch, others: Sequence[str], argument: str) -> list[Edit]:
    """Read `argument` wherever one of the other arguments is read."""
    reads = [each.args[0] for each in launch_file.calls("LaunchConfiguration") if each.args]
    found = [each for each in reads if isinstance(each, ast.Constant) and each.value in others]
    return [replace_node(launch_file.file.text, each, repr(argument)) for each in found]


def rename_argument_step(launch_file: Launch, other: str, right: str) -> str | None:
    """The step that renames the argument `other` to `right`."""
    return launch_file.step(rename_argument(launch_file, other, right))


def remap_nodes(launch_file: Launch, name: str, *without: str) -> str | None:
    """The step that gives every node the remapping from `name`, and drops the arguments in `without`."""
    same = len({each.topic for each in launch_file.programs()}) < 2
    values = _values(launch_file, "topic") if same else ()
    return launch_file.step(
        *(add_node_argument(launch_file, "remappings", f"[('{name}', {each})]", *without) for each in values)
    )


def put_into_namespace(launch_file: Launch, *without: str) -> str | None:
    """The step that puts every node into the namespace, and drops the arguments in `without`."""
    values = _values(launch_file, "namespace")
    return launch_file.step(*(add_node_argument(launch_file, "namespace", each, *without) for each in values))


def _values(launch_file: Launch, argument: str) -> tuple[str, ...]:
    """The expressions for the argument's value in the description of a node, in the order of preference.

    There are none where the argument is not declared, or a group passes its value to all nodes. A variable is not known
    in another function: there, a parameter of the same name may have any value.
    """
    if not launch_file.declared(argument) or launch_file.file.calls("PushRosNamespace", "PushROSNamespace", "SetRemap"):
        return ()
    within = {launch_file.file.function_around(call) for call in launch_file.calls("Node")}
    own = (value(launch_file.source, argument),) if within <= {launch_file.function} else ()
    return (*own, launch_file.value(argument))


def step_for_early_text(launch_file: Launch, name: str) -> str | None:
    """The step where a substitution was made part of a string."""
    source = launch_file.source
    known = {target for target, set_to in source.assignments() if "LaunchConfiguration(" in set_to}
    if (step := launch_file.step(_lists_instead_of_sums(launch_file, known))) is not None:
        return step
    for parts in source.texts():
        names = [part for part in parts if part in known or "LaunchConfiguration(" in part]
        if names:
            return remap_nodes(launch_file, name)
    return None


def _lists_instead_of_sums(launch_file: Launch, substitutions: Collection[str]) -> list[Edit]:
    """Make lists of sums of text and substitutions outside the description of a node, such as in a LogInfo."""
    file = launch_file.file
    within = {id(each) for call in file.calls("Node", "LifecycleNode") for each in ast.walk(call)}
    swaps: list[tuple[ast.expr, str]] = []
    for each in file.nodes:
        if not isinstance(each, ast.BinOp) or isinstance(next(file.ancestors(each), None), ast.BinOp):
            continue
        parts = summands(each)
        has_substitution = any(part in substitutions or "LaunchConfiguration(" in part for part in parts)
        if has_substitution and id(each) not in within:
            swaps.append((each, f"[{', '.join(parts)}]"))
    return replace_nodes(file.text, *swaps)


def remapping(source: Source, name: str) -> str:
    """The keyword argument that every node needs for the remapping from `name`."""
    return f"remappings=[('{name}', {value(source, 'topic')})]"


def with_own_names(source: Source, cause: Cause) -> Cause:
    """The cause with the file's own names for classes, and with the imports that the file lacks."""
    missing = []

    def with_own(text: str) -> str:
        return _CLASS_NAME.sub(lambda found: source.own(found[0]), text)

    for name, module in _MODULES.items():
        known = source.own(name) != name or source.imports(name) or source.imports("*") or "import " in cause.hint
        if source.readable and not known and re.search(rf"(?<![\w.']){name}\(", cause.hint):
            missing.append(f"from {module} import {name}")
    imports = f"\nat the top of the file: {'; '.join(missing)}" if missing else ""
    return Cause(cause.name, with_own(cause.text), with_own(cause.hint) + imports)
